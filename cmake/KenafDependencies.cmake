# Every library the project uses, all from Debian. docs/developing.md says what each is for.

# ---- Of the two libraries: all that is needed without the simulator.
#
# fmt and toml++ are compiled into them, from their headers, so that libkenaf needs libc, libstdc++, libgcc and
# TurboJPEG alone: libfmt has another name in each release of Debian, so one package could not serve two of them. None
# of the three is looked for by pkg-config, which need not be there.
find_package(Threads REQUIRED)
find_package(fmt 9 REQUIRED)

find_path(KENAF_TOML_FOLDER toml++/toml.h DOC "Folder of toml++'s headers")
if(NOT KENAF_TOML_FOLDER)
  message(FATAL_ERROR "toml++ is not installed: there is no toml++/toml.h (Debian: libtomlplusplus-dev)")
endif()

find_path(KENAF_TURBOJPEG_FOLDER turbojpeg.h DOC "Folder of TurboJPEG's header")
find_library(KENAF_TURBOJPEG_LIBRARY turbojpeg DOC "The library TurboJPEG")
if(NOT KENAF_TURBOJPEG_FOLDER OR NOT KENAF_TURBOJPEG_LIBRARY)
  message(FATAL_ERROR "TurboJPEG is not installed: there is no turbojpeg.h or no libturbojpeg (Debian: libturbojpeg0-dev)")
endif()
add_library(kenaf_turbojpeg INTERFACE IMPORTED)
target_include_directories(kenaf_turbojpeg INTERFACE "${KENAF_TURBOJPEG_FOLDER}")
target_link_libraries(kenaf_turbojpeg INTERFACE "${KENAF_TURBOJPEG_LIBRARY}")

# Of programs beside them. Without the simulator each is left out if what it needs is missing.
set(required REQUIRED)
if(NOT KENAF_BUILD_SIMULATOR)
  set(required QUIET)
endif()
find_package(CLI11 2 ${required})  # kenaf-canlog, the operator's programs
set(CURSES_NEED_NCURSES ON)
find_package(Curses ${required})   # the operator's console
if(NOT KENAF_BUILD_SIMULATOR)
  return()
endif()

# ---- Of the simulator and of what is built upon it.
find_package(PkgConfig REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
# Eigen would ask the processor for its caches, cut products to fit them, and so add up in another order on another
# processor: a diagnosis would not be the same bit for bit. Of all targets, as these functions are inline.
add_compile_definitions(EIGEN_NO_CPUID)
find_package(spdlog 1.10 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(Boost 1.74 REQUIRED COMPONENTS system)
find_package(console_bridge REQUIRED)
find_package(urdfdom REQUIRED)
find_package(EXPAT 2.5 REQUIRED)
find_package(PNG 1.6 REQUIRED)
find_package(embree 4 QUIET CONFIG)  # Debian 13
if(NOT embree_FOUND)
  find_package(embree 3.13 REQUIRED CONFIG)
endif()
pkg_check_modules(assimp REQUIRED IMPORTED_TARGET assimp>=5.2)
pkg_check_modules(tinyxml2 REQUIRED IMPORTED_TARGET tinyxml2>=9)
pkg_check_modules(nettle REQUIRED IMPORTED_TARGET nettle>=3.8)
pkg_check_modules(cairo REQUIRED IMPORTED_TARGET cairo)
pkg_check_modules(sqlite REQUIRED IMPORTED_TARGET sqlite3>=3.40)
find_package(BZip2 REQUIRED)
find_package(ZLIB REQUIRED)
pkg_check_modules(lz4 REQUIRED IMPORTED_TARGET liblz4>=1.9)
pkg_check_modules(zstd REQUIRED IMPORTED_TARGET libzstd>=1.5)

# The 3D library of the live view's page; a Debian package of JavaScript has no CMake file.
find_path(KENAF_THREE_FOLDER build/three.module.js PATHS /usr/share/javascript/three NO_DEFAULT_PATH REQUIRED
  DOC "Folder of three.js, with build/ and examples/")

# The double precision flavour of Bullet. Mixing its headers with the single precision libraries is an error that no
# linker reports, so headers, definition and libraries come from this one place.
pkg_check_modules(bullet REQUIRED IMPORTED_TARGET bullet-float64)
