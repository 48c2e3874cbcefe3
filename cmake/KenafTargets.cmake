# The settings that every target of the project shares, and the functions that declare targets.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_C_STANDARD 11)
set(CMAKE_C_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_C_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/lib")
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/lib")

# Contracted multiply-adds would let the same run differ between compilers and processors.
add_compile_options(-ffp-contract=off)

# What is installed says nothing of where it was built, neither by an assertion nor by the libraries' debug information.
# In the other builds a debugger finds the files by their whole paths.
add_compile_options("$<$<CONFIG:Release>:-ffile-prefix-map=${PROJECT_SOURCE_DIR}/=>")

# What is installed reads files and datagrams of strangers: Debian's hardening (dpkg-buildflags(1), hardening=+all).
set(optimised "$<CONFIG:Release,RelWithDebInfo,MinSizeRel>")
add_compile_options("$<${optimised}:-fstack-protector-strong;-fstack-clash-protection;-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=2>"
  -Wformat -Werror=format-security)
add_link_options("$<${optimised}:LINKER:-z,relro,-z,now>")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|amd64|i[3-6]86")
  add_compile_options("$<${optimised}:-fcf-protection>")
endif()
include(CheckPIESupported)
check_pie_supported()  # links programs with -pie, as they are compiled

if(KENAF_SANITIZE)
  add_compile_options(-fsanitize=${KENAF_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${KENAF_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    add_compile_options(-fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/cmake/sanitizer-ignorelist.txt)
  endif()
endif()
if(KENAF_FUZZ_COVERAGE)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

add_library(kenaf_warnings INTERFACE)
target_compile_options(kenaf_warnings INTERFACE -Wall -Wextra -Wconversion -Wshadow)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND KENAF_COMPILE_TOGETHER)
  # a source file of its own that is included is no header: what is in its unnamed namespace stays in it
  target_compile_options(kenaf_warnings INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-subobject-linkage>)
endif()
# g++ 12 warns wrongly of std::string's own operator+ in optimised builds (GCC bug 105651), and of <regex> under the
# sanitizers (GCC bug 105562).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(kenaf_warnings INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-restrict>)
  if(KENAF_PRECOMPILE_HEADERS)
    # likewise of a moved std::string, once its header is precompiled
    target_compile_options(kenaf_warnings INTERFACE
      $<$<COMPILE_LANGUAGE:CXX>:-Wno-array-bounds$<SEMICOLON>-Wno-stringop-overread$<SEMICOLON>-Wno-stringop-overflow>)
  endif()
  if(KENAF_SANITIZE)
    target_compile_options(kenaf_warnings INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-maybe-uninitialized>)
  endif()
endif()

# kenaf_precompile(NAME headers...): those headers of other projects, and the standard ones, are parsed once for the
# whole target. For targets of many files only. Every file names what it includes all the same: users build without.
function(kenaf_precompile name)
  if(KENAF_PRECOMPILE_HEADERS)
    list(TRANSFORM ARGN REPLACE "(.+)" "<\\1>" OUTPUT_VARIABLE headers)
    target_precompile_headers(${name} PRIVATE
      <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <limits> <map> <memory> <numbers> <optional>
      <span> <stdexcept> <string> <string_view> <utility> <vector> ${headers})
  endif()
endfunction()

# kenaf_compile_together(NAME): the files of a folder are compiled as one, so what is a file's alone (in an unnamed namespace)
# has a name that no other file of the folder has. Each names what it includes all the same: users compile each alone.
function(kenaf_compile_together name)
  if(NOT KENAF_COMPILE_TOGETHER)
    return()
  endif()
  set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${name} SOURCES)
  foreach(source ${sources})
    get_filename_component(folder "${source}" DIRECTORY)
    string(MAKE_C_IDENTIFIER "folder_${folder}" group)
    set_source_files_properties("${source}" PROPERTIES UNITY_GROUP "${group}")
  endforeach()
endfunction()

# kenaf_room(NAME sources...): the static library of one room. Includes are written from the root: "formats/protocol/frames.hpp".
function(kenaf_room name)
  add_library(${name} STATIC ${ARGN})
  kenaf_compile_together(${name})
  target_include_directories(${name} PUBLIC "${PROJECT_SOURCE_DIR}" "${PROJECT_SOURCE_DIR}/include")
  target_link_libraries(${name} PRIVATE kenaf_warnings)
endfunction()

# toml++ (KenafDependencies.cmake), for all rooms that read TOML.
add_library(kenaf_toml STATIC "${PROJECT_SOURCE_DIR}/cmake/tomlplusplus.cpp")
target_include_directories(kenaf_toml SYSTEM PUBLIC "${KENAF_TOML_FOLDER}")
target_compile_definitions(kenaf_toml PUBLIC TOML_HEADER_ONLY=0)

# kenaf_calculates(NAME): a room of long calculations, which are optimised under a sanitizer too. All else is not: it takes
# a third of the time to compile, and waits for others more than for itself.
function(kenaf_calculates name)
  if(KENAF_SANITIZE)
    target_compile_options(${name} PRIVATE -O1)
  endif()
endfunction()

# kenaf_compile_lightly(files...): files that read command lines. The library for that is thousands of inlined lines that run
# once: with less optimisation they take half as long to compile.
function(kenaf_compile_lightly)
  if(CMAKE_BUILD_TYPE STREQUAL "Release")
    set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS -O1)
  endif()
endfunction()

# kenaf_program(NAME sources... [COMPONENT c]): an installed program, with its main() in main.cpp. The component says
# which package it is in (KenafInstall.cmake).
function(kenaf_program name)
  cmake_parse_arguments(PROGRAM "" "COMPONENT" "" ${ARGN})
  if(NOT PROGRAM_COMPONENT)
    set(PROGRAM_COMPONENT programs)
  endif()
  set(sources ${PROGRAM_UNPARSED_ARGUMENTS})
  add_executable(${name} ${sources})
  list(FILTER sources INCLUDE REGEX "main\\.cpp$")
  kenaf_compile_lightly(${sources})
  target_link_libraries(${name} PRIVATE kenaf_warnings)
  install(TARGETS ${name} RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT ${PROGRAM_COMPONENT})
endfunction()

# kenaf_test_headers(): the program from which all tests have their precompiled headers. Comes before the first kenaf_test.
function(kenaf_test_headers)
  if(NOT KENAF_PRECOMPILE_HEADERS)
    return()
  endif()
  file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp" "int main() {}\n")
  add_executable(kenaf_test_headers "${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp")
  kenaf_test_settings(kenaf_test_headers)
  set(headers catch2/catch.hpp)
  if(KENAF_BUILD_SIMULATOR)
    target_link_libraries(kenaf_test_headers PRIVATE Eigen3::Eigen)
    list(APPEND headers Eigen/Geometry)
  endif()
  kenaf_precompile(kenaf_test_headers ${headers})
endfunction()

# What all tests are compiled with. Precompiled headers serve where these are the same.
function(kenaf_test_settings name)
  if(Catch2_VERSION VERSION_GREATER_EQUAL 3)
    target_include_directories(${name} SYSTEM PRIVATE "${PROJECT_SOURCE_DIR}/tests/support/catch2_v3")
  endif()
  target_link_libraries(${name} PRIVATE Catch2::Catch2WithMain Threads::Threads kenaf_warnings)
  target_compile_definitions(${name} PRIVATE KENAF_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  # what is tested is optimised; optimising the tests themselves too takes twice as long to compile
  # (and fortified functions need an optimiser)
  target_compile_options(${name} PRIVATE -O0 -U_FORTIFY_SOURCE)
  if(KENAF_FUZZ_COVERAGE)
    target_compile_options(${name} PRIVATE -fno-sanitize=fuzzer-no-link)
  endif()
endfunction()

# kenaf_check_hostile(SOURCE): each test case of the file has the tag [hostile].
function(kenaf_check_hostile source)
  file(READ ${source} text)
  string(REGEX MATCHALL "TEST_CASE\\(" cases "${text}")
  string(REGEX MATCHALL "\\[hostile\\]" tags "${text}")
  list(LENGTH cases cases)
  list(LENGTH tags tags)
  if(NOT cases EQUAL tags)
    message(FATAL_ERROR "${CMAKE_CURRENT_SOURCE_DIR}/${source}: ${cases} test cases, ${tags} tags [hostile]; each needs one")
  endif()
endfunction()

# kenaf_test(NAME SOURCES s... LIBRARIES l... LABELS l... [COST c] [ALONE]): one Catch2 program;
# ctest sees each of its test cases (under a sanitizer each of its files, which end in _test.cpp, without the cases tagged
# [long]), and starts those of the highest cost first. The cases of files whose names begin with hostile also have the
# label hostile, by their tag [hostile].
function(kenaf_test name)
  cmake_parse_arguments(TEST "ALONE" "COST" "SOURCES;LIBRARIES;LABELS" ${ARGN})
  if(NOT TEST_COST)
    set(TEST_COST 0)
  endif()
  add_executable(${name} ${TEST_SOURCES})
  kenaf_test_settings(${name})
  target_link_libraries(${name} PRIVATE ${TEST_LIBRARIES})
  if(KENAF_PRECOMPILE_HEADERS)
    target_precompile_headers(${name} REUSE_FROM kenaf_test_headers)
  endif()
  if(KENAF_COMPILE_TOGETHER)  # a folder of tests as one would leave the other core without work
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
  endif()
  if(NOT KENAF_SANITIZE)
    set(alone "")
    if(TEST_ALONE)
      set(alone RUN_SERIAL TRUE)
    endif()
    # a name that ctest takes for another (it parts them at semicolons) would run nothing, and pass; Catch2 3 refuses by itself
    set(none_fails EXTRA_ARGS --warn NoTests)
    if(Catch2_VERSION VERSION_GREATER_EQUAL 3)
      set(none_fails "")
    endif()
    # a program may have both hostile test cases and others: each get labels of their own
    set(hostile FALSE)
    set(others FALSE)
    foreach(source ${TEST_SOURCES})
      if(source MATCHES "hostile[^/]*_test\\.cpp$")
        set(hostile TRUE)
        kenaf_check_hostile(${source})
      elseif(source MATCHES "_test\\.cpp$")
        set(others TRUE)
      endif()
    endforeach()
    # Catch2's functions take lists apart four times on the way to the test's properties
    set(several "\\\\\\\\;")
    list(JOIN TEST_LABELS "${several}" labels)
    if(hostile)
      catch_discover_tests(${name}
        TEST_SPEC "[hostile]"
        ${none_fails}
        TEST_PREFIX "${name}: "
        PROPERTIES LABELS "${labels}${several}hostile" COST ${TEST_COST} ${alone})
    endif()
    if(others)
      catch_discover_tests(${name}
        TEST_SPEC "~[hostile]"
        ${none_fails}
        TEST_PREFIX "${name}: "
        PROPERTIES LABELS "${labels}" COST ${TEST_COST} ${alone})
    endif()
    return()
  endif()
  # a process takes a tenth of a second to start under a sanitizer: one for each file, not for each test case
  list(FILTER TEST_SOURCES INCLUDE REGEX "_test\\.cpp$")
  foreach(source ${TEST_SOURCES})
    get_filename_component(file ${source} NAME_WE)
    add_test(NAME "${name}: ${file}" COMMAND ${name} --filenames-as-tags "[#${file}]~[long]")
    set(labels ${TEST_LABELS})
    if(file MATCHES "^hostile")
      list(APPEND labels hostile)
    endif()
    set_tests_properties("${name}: ${file}" PROPERTIES LABELS "${labels}" COST ${TEST_COST})
  endforeach()
endfunction()

# kenaf_fuzzer(NAME SOURCE s LIBRARIES l...): one libFuzzer target, seeded from tests/fuzz/corpus/NAME.
function(kenaf_fuzzer name)
  cmake_parse_arguments(FUZZ "" "SOURCE" "LIBRARIES" ${ARGN})
  add_executable(${name} ${FUZZ_SOURCE})
  target_link_libraries(${name} PRIVATE ${FUZZ_LIBRARIES} kenaf_warnings)
  target_compile_options(${name} PRIVATE -fsanitize=fuzzer-no-link)  # without any coverage libFuzzer gives up
  target_link_options(${name} PRIVATE -fsanitize=fuzzer)
  set_property(GLOBAL APPEND PROPERTY KENAF_FUZZERS ${name})
endfunction()
