// Where the files that ship with the project are found: robots/, worlds/.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace kenaf {

// The path of `name` + `extension` in `folder` ("robots", "worlds"): first below $KENAF_DATA_DIR, then below the
// install prefix's share/kenaf (found relative to the running program), then below the source tree this was built
// from. Where `name` contains a '/' or ends in `extension` it is a path and is returned as it is.
// Empty: not found anywhere.
std::filesystem::path find_data_file(std::string_view folder, const std::string& name, std::string_view extension);

}  // namespace kenaf
