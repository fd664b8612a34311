# The target `doc`: API pages of the public headers. A warning of Doxygen is an error.
find_program(HEXSPLINE_DOXYGEN doxygen)
if(HEXSPLINE_DOXYGEN)
    set(HEXSPLINE_DOC_FOLDER "${PROJECT_BINARY_DIR}/doc")
    configure_file("${PROJECT_SOURCE_DIR}/docs/api/Doxyfile.in" "${PROJECT_BINARY_DIR}/Doxyfile" @ONLY)
    add_custom_target(doc COMMAND ${CMAKE_COMMAND} -E make_directory "${HEXSPLINE_DOC_FOLDER}"
                          COMMAND ${HEXSPLINE_DOXYGEN} "${PROJECT_BINARY_DIR}/Doxyfile" VERBATIM)
endif()
