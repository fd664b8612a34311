# What a packaged hexspline has besides: man pages, completion, and `cpack -G DEB` (build everything first).
install(FILES "${PROJECT_SOURCE_DIR}/tools/completion/hexspline.bash" RENAME hexspline
        DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions")
install(FILES "${PROJECT_SOURCE_DIR}/tools/completion/_hexspline" DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions")

# The man pages say what --help says.
find_program(HEXSPLINE_MAN_PYTHON python3)
if(TARGET hexspline AND HEXSPLINE_MAN_PYTHON AND NOT HEXSPLINE_SANITIZE)
    set(man_folder "${PROJECT_BINARY_DIR}/man1")
    add_custom_command(OUTPUT "${man_folder}/hexspline.1"
                       COMMAND ${HEXSPLINE_MAN_PYTHON} "${PROJECT_SOURCE_DIR}/tools/man-pages" $<TARGET_FILE:hexspline> "${man_folder}"
                       DEPENDS hexspline "${PROJECT_SOURCE_DIR}/tools/man-pages" COMMENT "Man pages" VERBATIM)
    add_custom_target(man_pages ALL DEPENDS "${man_folder}/hexspline.1")
    install(DIRECTORY "${man_folder}/" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" OPTIONAL)
endif()

if(PROJECT_IS_TOP_LEVEL)
    set(CPACK_GENERATOR DEB)
    set(CPACK_PACKAGE_NAME hexspline)
    set(CPACK_PACKAGE_CONTACT "The authors of hexspline")
    set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
    set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
    set(CPACK_STRIP_FILES ON)
    set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
    set(CPACK_DEBIAN_PACKAGE_SECTION science)
    # The libraries that the binaries are linked to, asked from dpkg; the headers of those that our headers include.
    find_program(HEXSPLINE_SHLIBDEPS dpkg-shlibdeps)
    if(HEXSPLINE_SHLIBDEPS)
        set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
        set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${PROJECT_BINARY_DIR}/lib")
    endif()
    set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libeigen3-dev, libtbb-dev, libopenmesh-dev")
    include(CPack)
endif()
