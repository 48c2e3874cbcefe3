// Finds and reads the file of a robot's, world's or manoeuvre's description. Thread safety: as data_files.hpp.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kenaf::description {

inline constexpr std::size_t kMostDescriptionBytes = std::size_t{16} << 20U;

struct DescriptionFile {
  std::string path;  // for errors
  std::string text;
};

// `kind` is "robot", "world" or "manoeuvre": find_data_file() looks in the folder `kind` + "s". Throws DescriptionError
// if there is no such file, or it cannot be read, is no regular file, or has more than kMostDescriptionBytes.
DescriptionFile read_description_file(std::string_view kind, const std::string& name_or_path,
                                      std::string_view extension);

// For options, before anything is read: throws DescriptionError, "must be the path of a file that ends in .sdf, or one
// of flat, ...; did you mean flat?", if the text is neither the name of a shipped description nor a path.
void require_description(std::string_view kind, const std::string& name_or_path, std::string_view extension);

}  // namespace kenaf::description
