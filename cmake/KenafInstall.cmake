# What is installed beside the programs, find_package(kenaf), pkg-config, and the Debian package.
include(CMakePackageConfigHelpers)

install(FILES include/kenaf/hrt.h DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/kenaf")
install(DIRECTORY robots worlds manoeuvres DESTINATION "${CMAKE_INSTALL_DATADIR}/kenaf"
  FILES_MATCHING PATTERN "*.toml" PATTERN "*.sdf" PATTERN "*.png" PATTERN "*.obj")
install(FILES README.md CHANGELOG.md LICENSE DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(DIRECTORY docs/ DESTINATION "${CMAKE_INSTALL_DOCDIR}/docs" FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg")
install(DIRECTORY examples/ DESTINATION "${CMAKE_INSTALL_DOCDIR}/examples" FILES_MATCHING
  PATTERN "*.c" PATTERN "*.h" PATTERN "*.cpp" PATTERN "*.hpp" PATTERN "*.script")

set(cmake_dir "${CMAKE_INSTALL_LIBDIR}/cmake/kenaf")
install(EXPORT kenafTargets NAMESPACE kenaf:: DESTINATION "${cmake_dir}")
configure_package_config_file(cmake/kenafConfig.cmake.in "${CMAKE_CURRENT_BINARY_DIR}/kenafConfig.cmake"
  INSTALL_DESTINATION "${cmake_dir}")
write_basic_package_version_file("${CMAKE_CURRENT_BINARY_DIR}/kenafConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/kenafConfig.cmake" "${CMAKE_CURRENT_BINARY_DIR}/kenafConfigVersion.cmake"
  DESTINATION "${cmake_dir}")

# Relative to the .pc file, so that `cmake --install --prefix` elsewhere still works.
file(RELATIVE_PATH prefix_from_pc "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
foreach(library real sim)
  configure_file(cmake/kenaf-${library}.pc.in "${CMAKE_CURRENT_BINARY_DIR}/kenaf-${library}.pc" @ONLY)
  install(FILES "${CMAKE_CURRENT_BINARY_DIR}/kenaf-${library}.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME kenaf)
set(CPACK_PACKAGE_CONTACT "Kenaf maintainers <maintainers@kenaf.example>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION "A C interface to a tracked rescue robot with four flippers, two libraries behind it that
differ in what they drive - the robot over SocketCAN, or its simulation over UDP - and the
simulator: a relay daemon and a world server that speaks the USARSim protocol.")
set(CPACK_PACKAGING_INSTALL_PREFIX "/usr")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA "${CMAKE_CURRENT_BINARY_DIR}/triggers")
file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/triggers" "activate-noawait ldconfig\n")
include(CPack)
