# Every library the project uses, all from Debian 12. docs/developing.md says what each is for.
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
# Eigen would ask the processor for its caches, cut products to fit them, and so add up in another order on another
# processor: a diagnosis would not be the same bit for bit. Of all targets, as these functions are inline.
add_compile_definitions(EIGEN_NO_CPUID)
find_package(fmt 9 REQUIRED)
find_package(spdlog 1.10 REQUIRED)
find_package(CLI11 2 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(Boost 1.74 REQUIRED COMPONENTS system)
find_package(sdformat12 REQUIRED)
find_package(console_bridge REQUIRED)
find_package(urdfdom REQUIRED)
find_package(EXPAT 2.5 REQUIRED)
find_package(PNG 1.6 REQUIRED)
find_package(embree 3.13 REQUIRED CONFIG)
set(CURSES_NEED_NCURSES ON)
find_package(Curses REQUIRED)
pkg_check_modules(assimp REQUIRED IMPORTED_TARGET assimp>=5.2)
pkg_check_modules(tinyxml2 REQUIRED IMPORTED_TARGET tinyxml2>=9)
pkg_check_modules(tomlplusplus REQUIRED IMPORTED_TARGET tomlplusplus)
pkg_check_modules(nettle REQUIRED IMPORTED_TARGET nettle>=3.8)
pkg_check_modules(cairo REQUIRED IMPORTED_TARGET cairo)
pkg_check_modules(sqlite REQUIRED IMPORTED_TARGET sqlite3>=3.40)
find_package(BZip2 REQUIRED)
find_package(ZLIB REQUIRED)
pkg_check_modules(lz4 REQUIRED IMPORTED_TARGET liblz4>=1.9)
pkg_check_modules(zstd REQUIRED IMPORTED_TARGET libzstd>=1.5)
pkg_check_modules(turbojpeg REQUIRED IMPORTED_TARGET libturbojpeg>=2.1)

# The 3D library of the live view's page; a Debian package of JavaScript has no CMake file.
find_path(KENAF_THREE_FOLDER build/three.module.js PATHS /usr/share/javascript/three NO_DEFAULT_PATH REQUIRED
  DOC "Folder of three.js, with build/ and examples/")

# The double precision flavour of Bullet. Mixing its headers with the single precision libraries is an error that no
# linker reports, so headers, definition and libraries come from this one place.
pkg_check_modules(bullet REQUIRED IMPORTED_TARGET bullet-float64)
