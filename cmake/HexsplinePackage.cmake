# What a packaged hexspline has besides: documentation, man pages, completion, and `cpack -G DEB` (build everything first).

# A project that contains this one has documentation of its own in that place.
if(PROJECT_IS_TOP_LEVEL)
    # The pages, with what they link to, lie to each other as they do here. Build folders and the like are left behind.
    install(FILES "${PROJECT_SOURCE_DIR}/README.md" "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/CONTRIBUTING.md"
                  "${PROJECT_SOURCE_DIR}/CHANGELOG.md" "${PROJECT_SOURCE_DIR}/CITATION.cff"
            DESTINATION "${CMAKE_INSTALL_DOCDIR}")
    install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs" DESTINATION "${CMAKE_INSTALL_DOCDIR}"
            FILES_MATCHING REGEX "\\.(md|png|schema\\.json|bib)$" PATTERN api EXCLUDE)
    install(DIRECTORY "${PROJECT_SOURCE_DIR}/data" DESTINATION "${CMAKE_INSTALL_DOCDIR}"
            FILES_MATCHING REGEX "\\.(md|stl|k|step|igs|brep|py|cpp)$" PATTERN __pycache__ EXCLUDE)
    install(DIRECTORY "${PROJECT_SOURCE_DIR}/plugins" DESTINATION "${CMAKE_INSTALL_DOCDIR}"
            FILES_MATCHING REGEX "/plugins/[^/]+/(CMakeLists\\.txt|[^/]+\\.(cpp|h))$" PATTERN build EXCLUDE)

    # What Debian looks for in every package: whose it is, what changed, in the program and in the package.
    install(FILES "${PROJECT_SOURCE_DIR}/cmake/debian/copyright" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
    find_program(HEXSPLINE_GZIP gzip)
    if(HEXSPLINE_GZIP)
        set(changelog "${PROJECT_BINARY_DIR}/changelogs/changelog")
        configure_file("${PROJECT_SOURCE_DIR}/cmake/debian/changelog.in" "${changelog}.debian" @ONLY)
        # -n: no name and no time in it, so that the same text is the same bytes.
        add_custom_command(OUTPUT "${changelog}.gz" "${changelog}.Debian.gz"
                           COMMAND ${CMAKE_COMMAND} -E copy "${PROJECT_SOURCE_DIR}/CHANGELOG.md" "${changelog}"
                           COMMAND ${CMAKE_COMMAND} -E copy "${changelog}.debian" "${changelog}.Debian"
                           COMMAND ${HEXSPLINE_GZIP} -9nf "${changelog}" "${changelog}.Debian"
                           DEPENDS "${PROJECT_SOURCE_DIR}/CHANGELOG.md" "${changelog}.debian" COMMENT "Changelogs" VERBATIM)
        add_custom_target(hexspline_changelogs ALL DEPENDS "${changelog}.gz" "${changelog}.Debian.gz")
        install(FILES "${changelog}.gz" "${changelog}.Debian.gz" DESTINATION "${CMAKE_INSTALL_DOCDIR}" OPTIONAL)
    endif()
endif()

install(FILES "${PROJECT_SOURCE_DIR}/tools/completion/hexspline.bash" RENAME hexspline
        DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions")
install(FILES "${PROJECT_SOURCE_DIR}/tools/completion/_hexspline" DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions")

# The man pages say what --help says.
find_program(HEXSPLINE_MAN_PYTHON python3)
if(TARGET hexspline AND HEXSPLINE_MAN_PYTHON AND NOT HEXSPLINE_SANITIZE)
    set(man_folder "${PROJECT_BINARY_DIR}/man1")
    add_custom_command(OUTPUT "${man_folder}/hexspline.1.gz"
                       COMMAND ${HEXSPLINE_MAN_PYTHON} "${PROJECT_SOURCE_DIR}/tools/man-pages" $<TARGET_FILE:hexspline> "${man_folder}"
                       DEPENDS hexspline "${PROJECT_SOURCE_DIR}/tools/man-pages" COMMENT "Man pages" VERBATIM)
    add_custom_target(man_pages ALL DEPENDS "${man_folder}/hexspline.1.gz")
    install(DIRECTORY "${man_folder}/" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" OPTIONAL FILES_MATCHING PATTERN "*.1.gz")
endif()

if(PROJECT_IS_TOP_LEVEL)
    set(CPACK_GENERATOR DEB)
    set(CPACK_PACKAGE_NAME hexspline)
    set(CPACK_PACKAGE_CONTACT "The hexspline developers")
    set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
    set(CPACK_PACKAGE_DESCRIPTION_FILE "${PROJECT_SOURCE_DIR}/cmake/debian/description")
    set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
    set(CPACK_STRIP_FILES ON)
    set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
    # The first packaging of this version: changelog.gz is the program's, changelog.Debian.gz the package's.
    set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
    set(CPACK_DEBIAN_PACKAGE_SECTION science)
    set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_SOURCE_DIR}/cmake/debian/permissions.cmake")
    set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
    set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/cmake/debian/triggers")
    # The libraries that the binaries are linked to, asked from dpkg; the headers of those that our headers include.
    find_program(HEXSPLINE_SHLIBDEPS dpkg-shlibdeps)
    if(HEXSPLINE_SHLIBDEPS)
        set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
        set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
        set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${PROJECT_BINARY_DIR}/lib")
    endif()
    set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libeigen3-dev, libtbb-dev, libopenmesh-dev")
    include(CPack)
endif()
