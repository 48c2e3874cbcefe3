// Finds and reads the file of a robot's or a world's description. Thread safety: as data_files.hpp.
#pragma once

#include <string>
#include <string_view>

namespace kenaf::description {

struct DescriptionFile {
  std::string path;  // for errors
  std::string text;
};

// `kind` is "robot" or "world": the file is looked for in its folder, `kind` + "s", as find_data_file() does it.
// Throws DescriptionError where there is no such file or it cannot be read.
DescriptionFile read_description_file(std::string_view kind, const std::string& name_or_path,
                                      std::string_view extension);

}  // namespace kenaf::description
