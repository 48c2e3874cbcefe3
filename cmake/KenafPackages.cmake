# The Debian packages, one for each component of the installation. What a package has that `cmake --install` does not, or
# has otherwise, is done by DebianStaging.cmake.

set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)  # a package for each component
set(CPACK_COMPONENTS_ALL library development data)
if(KENAF_BUILD_SIMULATOR)  # otherwise the programs are tools of developers
  list(APPEND CPACK_COMPONENTS_ALL programs)
endif()
set(CPACK_PACKAGE_CONTACT "Kenaf maintainers <maintainers@kenaf.example>")
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(kenaf_package_version "${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}")
set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_SOURCE_DIR}/cmake/DebianStaging.cmake")
set(CPACK_KENAF_SOURCE "${PROJECT_SOURCE_DIR}")
set(CPACK_KENAF_DOCDIR "${CMAKE_INSTALL_DOCDIR}")
set(CPACK_KENAF_VERSION "${kenaf_package_version}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGING_INSTALL_PREFIX "/usr")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${PROJECT_BINARY_DIR}/lib")  # where the libraries are, for the Python modules
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)  # on the same version of the others

# The libraries without the simulator: on a robot's computer Bullet, Embree and OpenMPI have no business.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libkenaf${KENAF_ABI})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "control of a tracked rescue robot, or of its simulation
Two libraries with one C interface: libkenaf_real drives the robot over
SocketCAN, libkenaf_sim its simulation over UDP. A program is linked with
one of them.")
# The robot's description says what is on its bus. Not the same version: libraries of two interfaces may be installed
# beside each other, and of the data there is one.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "kenaf-data (>= ${PROJECT_VERSION})")
file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/triggers" "activate-noawait ldconfig\n")
# what dpkg-shlibdeps writes into the package of a program that is linked with one of them
set(needed "libkenaf${KENAF_ABI} (>= ${PROJECT_VERSION})")
file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/shlibs"
  "libkenaf_real ${KENAF_ABI} ${needed}\nlibkenaf_sim ${KENAF_ABI} ${needed}\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA
  "${CMAKE_CURRENT_BINARY_DIR}/triggers;${CMAKE_CURRENT_BINARY_DIR}/shlibs")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libkenaf-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "control of a tracked rescue robot: to build programs with
The C header kenaf/hrt.h, its manual page, and what finds the libraries:
for CMake, find_package(kenaf), and for pkg-config, kenaf-sim and kenaf-real.")
set(CPACK_COMPONENT_DEVELOPMENT_DEPENDS library)

set(CPACK_DEBIAN_DATA_PACKAGE_NAME kenaf-data)
set(CPACK_DEBIAN_DATA_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DATA_DESCRIPTION "robots, worlds and manoeuvres of Kenaf
Descriptions that the libraries read on the robot, and that the simulator
makes its world of.")

set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME kenaf)
set(kenaf_units "kenaf-world.service kenaf-relayd.service")
set(CPACK_DEBIAN_PROGRAMS_DESCRIPTION "simulator of a tracked rescue robot with four flippers
A world server that speaks the USARSim protocol, with a page for browsers
and the robot's cameras, the relay between it and programs on libkenaf_sim,
simulated CANopen drives, and kenaf-gap, which measures how far simulation
and robot are apart, and says why.")
set(CPACK_COMPONENT_PROGRAMS_DEPENDS data)
# three.js of the page: DebianStaging.cmake makes share/kenaf/three a link to it
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS "libjs-three (>= 111)")
# The services' start, stop and restart; the three scripts have the units' names once, here.
foreach(script postinst prerm postrm)
  configure_file(cmake/debian/${script}.in "${CMAKE_CURRENT_BINARY_DIR}/debian/${script}" @ONLY)
  list(APPEND service_scripts "${CMAKE_CURRENT_BINARY_DIR}/debian/${script}")
endforeach()
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_CONTROL_EXTRA "${service_scripts}")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_CONTROL_STRICT_PERMISSION TRUE)

if(TARGET operator_console)
  list(APPEND CPACK_COMPONENTS_ALL operator)
  set(CPACK_DEBIAN_OPERATOR_PACKAGE_NAME kenaf-operator)
  set(CPACK_DEBIAN_OPERATOR_DESCRIPTION "drives a tracked rescue robot, or its simulation, by hand
operator_console is the console on the operator's machine, for keyboard and
gamepad; operator_control_real on the robot, and operator_control_sim beside
its simulation, carry out what it sends.")
  set(CPACK_COMPONENT_OPERATOR_DEPENDS library)
endif()

if(TARGET kenaf-gap-mpi)
  list(APPEND CPACK_COMPONENTS_ALL mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_NAME kenaf-gap-mpi)
  set(CPACK_DEBIAN_MPI_DESCRIPTION "kenaf-gap's diagnosis by several processes
Shares the work of kenaf-gap diagnose between the processes that mpirun
starts, on one or more machines.")
  set(CPACK_COMPONENT_MPI_DEPENDS data)
  set(CPACK_DEBIAN_MPI_PACKAGE_RECOMMENDS mpi-default-bin)  # mpirun
endif()

if(KENAF_HAS_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-kenaf)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "simulation and control of tracked robots, for Python
Simulated and recorded runs as NumPy arrays, many at once on all cores, the
diagnosis of what differs between robot and simulation, and hrt.h as a
module over either library.")
  set(CPACK_COMPONENT_PYTHON_DEPENDS data library)
  math(EXPR next_minor "${KENAF_PYTHON_MINOR} + 1")  # a module is for one minor version of the interpreter
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= 3.${KENAF_PYTHON_MINOR}), python3 (<< 3.${next_minor}), python3-numpy (>= 1:1.24)")
endif()

foreach(component ${CPACK_COMPONENTS_ALL})
  string(TOUPPER ${component} key)
  install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/doc/${CPACK_DEBIAN_${key}_PACKAGE_NAME}"
    RENAME copyright COMPONENT ${component})
endforeach()
include(CPack)
