# What is installed beside the programs, find_package(kenaf) and pkg-config. A component of the installation is a Debian
# package (KenafPackages.cmake): library, development, data, programs, operator, mpi, python.
include(CMakePackageConfigHelpers)

install(FILES include/kenaf/hrt.h DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/kenaf" COMPONENT development)
install(DIRECTORY share/devices share/robots share/worlds share/manoeuvres DESTINATION "${CMAKE_INSTALL_DATADIR}/kenaf" COMPONENT data
  FILES_MATCHING PATTERN "*.toml" PATTERN "*.sdf" PATTERN "*.png" PATTERN "*.obj")
install(FILES README.md CHANGELOG.md LICENSE DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT programs)
install(DIRECTORY docs/ DESTINATION "${CMAKE_INSTALL_DOCDIR}/docs" COMPONENT programs
  FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg")
install(FILES include/kenaf/hrt.h DESTINATION "${CMAKE_INSTALL_DOCDIR}/include/kenaf" COMPONENT programs)  # pages lead to it
install(DIRECTORY examples teleop DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT programs FILES_MATCHING
  PATTERN "*.c" PATTERN "*.h" PATTERN "*.cpp" PATTERN "*.hpp" PATTERN "*.script" PATTERN "*.py")
# What the operator's program includes of other rooms, so that it can be built where it is installed.
install(DIRECTORY command_line DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT programs
  FILES_MATCHING PATTERN "*.cpp" PATTERN "*.hpp")
install(DIRECTORY formats/settings DESTINATION "${CMAKE_INSTALL_DOCDIR}/formats" COMPONENT programs
  FILES_MATCHING PATTERN "*.cpp" PATTERN "*.hpp")
install(FILES formats/protocol/datagram_codec.cpp formats/protocol/datagram_codec.hpp
  formats/protocol/host_port.cpp formats/protocol/host_port.hpp formats/protocol/log_limiter.hpp
  formats/protocol/reached_address.cpp formats/protocol/reached_address.hpp
  DESTINATION "${CMAKE_INSTALL_DOCDIR}/formats/protocol" COMPONENT programs)
install(FILES formats/runs/port_file.cpp formats/runs/port_file.hpp formats/runs/run_file.hpp
  formats/runs/whole_file.cpp formats/runs/whole_file.hpp
  DESTINATION "${CMAKE_INSTALL_DOCDIR}/formats/runs" COMPONENT programs)

set(cmake_dir "${CMAKE_INSTALL_LIBDIR}/cmake/kenaf")
install(EXPORT kenafTargets NAMESPACE kenaf:: DESTINATION "${cmake_dir}" COMPONENT development)
configure_package_config_file(cmake/kenafConfig.cmake.in "${CMAKE_CURRENT_BINARY_DIR}/kenafConfig.cmake"
  INSTALL_DESTINATION "${cmake_dir}")
write_basic_package_version_file("${CMAKE_CURRENT_BINARY_DIR}/kenafConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/kenafConfig.cmake" "${CMAKE_CURRENT_BINARY_DIR}/kenafConfigVersion.cmake"
  DESTINATION "${cmake_dir}" COMPONENT development)

# Relative to the .pc file, so that `cmake --install --prefix` elsewhere still works.
file(RELATIVE_PATH prefix_from_pc "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
foreach(library real sim)
  configure_file(cmake/kenaf-${library}.pc.in "${CMAKE_CURRENT_BINARY_DIR}/kenaf-${library}.pc" @ONLY)
  install(FILES "${CMAKE_CURRENT_BINARY_DIR}/kenaf-${library}.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig"
    COMPONENT development)
endforeach()

# A project that has Kenaf as a part of it makes its own packages.
if(PROJECT_IS_TOP_LEVEL)
  include(KenafPackages)
endif()
