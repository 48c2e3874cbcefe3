// Finds the files that ship with the project, those below share/: robots, worlds, manoeuvres.
//
// Thread safety: any thread, while none changes the environment.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::description {

// All places where they are looked for, in that order, whether they exist or not.
std::vector<std::filesystem::path> data_roots();

// The path of `name` + `extension` in `folder` ("robots", "worlds"): first below $KENAF_DATA_DIR, then below
// share/kenaf of the install prefix or the build tree, which are found relative to the running program, and to the
// shared library that asks. Where `name` contains a '/' or ends in `extension` it is a path and is returned as it is.
// Empty: not found anywhere.
std::filesystem::path find_data_file(std::string_view folder, const std::string& name, std::string_view extension);

// All of `folder` that end in `extension`, by file name; where a name is in more than one of those places, the first.
std::vector<std::filesystem::path> list_data_files(std::string_view folder, std::string_view extension);

}  // namespace kenaf::description
