#include "physics/description_file.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "physics/robot_description.hpp"
#include "protocol/data_files.hpp"

namespace kenaf::physics {

DescriptionFile read_description_file(std::string_view kind, const std::string& name_or_path,
                                      std::string_view extension) {
  const std::string folder = std::string(kind) + "s";
  const std::filesystem::path path = find_data_file(folder, name_or_path, extension);
  if (path.empty())
    throw DescriptionError(
        fmt::format("{} \"{}\": no such description; give the name of a file in {}/ without its ending, or the path of "
                    "a file that ends in {}",
                    kind, name_or_path, folder, extension));
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in || text.fail())
    throw DescriptionError(
        fmt::format("{}: cannot be read; check that the file exists and its permissions", path.string()));
  return {path.string(), text.str()};
}

}  // namespace kenaf::physics
