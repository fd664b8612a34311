# The installed CMake package: find_package(hexspline) gives hexspline::hex and hexspline::spline.
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/hexspline")
install(EXPORT hexspline_targets NAMESPACE hexspline:: FILE hexspline-targets.cmake DESTINATION "${package_dir}")
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/hexspline-config.cmake.in"
                              "${PROJECT_BINARY_DIR}/hexspline-config.cmake" INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/hexspline-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/hexspline-config.cmake" "${PROJECT_BINARY_DIR}/hexspline-config-version.cmake"
              "${PROJECT_SOURCE_DIR}/cmake/FindOpenMeshCore.cmake"
        DESTINATION "${package_dir}")
include(HexsplinePackage)
