#include "formats/description/description_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "formats/description/data_files.hpp"
#include "formats/description/description_error.hpp"
#include "formats/description/limited_file.hpp"

namespace kenaf::description {
namespace {

std::string shipped_names(const std::string& folder, std::string_view extension) {
  std::vector<std::string> names;
  for (const std::filesystem::path& path : list_data_files(folder, extension)) names.push_back(path.stem().string());
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

DescriptionFile read_description_file(std::string_view kind, const std::string& name_or_path,
                                      std::string_view extension) {
  const std::string folder = std::string(kind) + "s";
  const std::filesystem::path path = find_data_file(folder, name_or_path, extension);
  if (path.empty())
    throw DescriptionError(
        fmt::format("{0} \"{1}\": no such {0}; give the path of a file that ends in {2}, or one of {3}", kind,
                    name_or_path, extension, shipped_names(folder, extension)));
  try {
    return {path.string(), read_limited_file(path, kMostDescriptionBytes)};
  } catch (const DescriptionError& error) {
    throw DescriptionError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

}  // namespace kenaf::description
