# cmake -DBUILD_DIR= -DCONSUMER_DIR= -DWORK_DIR= -DBUILD_TYPE= -P install_test.cmake
function(run)
    execute_process(COMMAND ${ARGV} RESULT_VARIABLE result)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "failed: ${ARGV}")
    endif()
endfunction()

function(expect text)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output)
    if(NOT result EQUAL 0 OR NOT output STREQUAL text)
        message(FATAL_ERROR "${ARGN} (${result}) wrote\n${output}instead of\n${text}")
    endif()
endfunction()

file(REMOVE_RECURSE "${WORK_DIR}")
set(prefix "${WORK_DIR}/prefix")
run(${CMAKE_COMMAND} --install "${BUILD_DIR}" --prefix "${prefix}")
set(flags "")
if(SANITIZE)
    string(REPLACE ";" "," SANITIZE "${SANITIZE}")
    set(flags "-DCMAKE_CXX_FLAGS=-fsanitize=${SANITIZE}")
endif()
run(${CMAKE_COMMAND} -G Ninja -S "${CONSUMER_DIR}" -B "${WORK_DIR}/build" -DCMAKE_BUILD_TYPE=${BUILD_TYPE}
    "-DCMAKE_PREFIX_PATH=${prefix}" ${flags})
run(${CMAKE_COMMAND} --build "${WORK_DIR}/build")
# Moved to another place, the installed tree still works: nothing in it points back to the build.
file(RENAME "${prefix}" "${WORK_DIR}/moved")
expect("12 vertices, 2 hexahedra, 1 interior face\n"
       ${CMAKE_COMMAND} -E env "LD_LIBRARY_PATH=${WORK_DIR}/moved/lib" "${WORK_DIR}/build/consumer")
expect("hexspline ${VERSION}\n" "${WORK_DIR}/moved/bin/hexspline" --version)
