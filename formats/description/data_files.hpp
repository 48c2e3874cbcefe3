// Finds the files that ship with the project, below share/: robots, worlds, manoeuvres.
//
// Thread safety: any thread, as long as none changes the environment.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::description {

// All folders that are searched, in that order, whether they exist or not.
std::vector<std::filesystem::path> data_roots();

// Returns the path of `name` + `extension` in `folder` ("robots", "worlds"): first below $KENAF_DATA_DIR, then below
// share/kenaf of the install prefix or the build tree, found relative to the running program and to the shared library
// with this code. If `name` contains a '/' or ends in `extension`, it is a path and is returned unchanged. Returns an
// empty path if there is no such file.
std::filesystem::path find_data_file(std::string_view folder, const std::string& name, std::string_view extension);

// All files of `folder` that end in `extension`, sorted by name; of several with one name, the first that is found.
std::vector<std::filesystem::path> list_data_files(std::string_view folder, std::string_view extension);

}  // namespace kenaf::description
