# Settings every target of this project shares: language level, warnings, sanitizers, ccache, output folders.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/lib")
set(CMAKE_INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR};$ORIGIN")

find_program(HEXSPLINE_CCACHE ccache)
if(HEXSPLINE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER "${HEXSPLINE_CCACHE}")
endif()

add_library(hexspline_settings INTERFACE)
# Contraction of a*b+c would make results depend on the compiler's choices; we promise the same bytes everywhere.
target_compile_options(hexspline_settings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                                                    -Woverloaded-virtual -ffp-contract=off)
if(HEXSPLINE_WERROR)
    target_compile_options(hexspline_settings INTERFACE -Werror)
endif()
if(HEXSPLINE_SANITIZE)
    string(REPLACE ";" "," sanitizers "${HEXSPLINE_SANITIZE}")
    # GCC 12 sees uninitialised values in the code that sanitizers add.
    add_compile_options(-fsanitize=${sanitizers} -fno-omit-frame-pointer -fno-sanitize-recover=all
                        -Wno-maybe-uninitialized)
    add_link_options(-fsanitize=${sanitizers})
endif()
if(HEXSPLINE_COVERAGE)
    # Of the libraries: what the tests run of libhex and libspline. Reported by the target `coverage` after the tests.
    add_compile_options(--coverage -fprofile-update=atomic)
    add_link_options(--coverage)
    find_program(HEXSPLINE_GCOVR gcovr REQUIRED)
    set(counted "${PROJECT_BINARY_DIR}/coverage.json")
    set(report ${HEXSPLINE_GCOVR} --root "${PROJECT_SOURCE_DIR}" --add-tracefile "${counted}" --sort-percentage)
    # Every library is shown before one that has too little fails the target.
    foreach(library libhex libspline)
        list(APPEND shown COMMAND ${CMAKE_COMMAND} -E echo "== ${library}"
                          COMMAND ${report} --filter "${PROJECT_SOURCE_DIR}/${library}/" --print-summary)
        list(APPEND demanded COMMAND ${CMAKE_COMMAND} -E echo "== ${library}: at least 90 % of the lines"
                             COMMAND ${report} --filter "${PROJECT_SOURCE_DIR}/${library}/" --fail-under-line 90 --print-summary
                                     --output "${PROJECT_BINARY_DIR}/${library}.txt")
    endforeach()
    add_custom_target(coverage COMMAND ${HEXSPLINE_GCOVR} --root "${PROJECT_SOURCE_DIR}" --filter "${PROJECT_SOURCE_DIR}/lib(hex|spline)/"
                                       --exclude-throw-branches --json "${counted}" "${PROJECT_BINARY_DIR}"
                               COMMAND ${report} --html "${PROJECT_BINARY_DIR}/coverage.html"
                               ${shown} ${demanded} VERBATIM)
endif()
