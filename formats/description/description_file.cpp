#include "formats/description/description_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "formats/description/data_files.hpp"
#include "formats/description/description_error.hpp"
#include "formats/description/limited_file.hpp"
#include "formats/settings/nearest_word.hpp"

namespace kenaf::description {
namespace {

std::vector<std::string> shipped_names(const std::string& folder, std::string_view extension) {
  std::vector<std::string> names;
  for (const std::filesystem::path& path : list_data_files(folder, extension)) names.push_back(path.stem().string());
  return names;
}

// "the path of a file that ends in .sdf, or one of flat, stairs; did you mean flat?"
std::string choices(const std::string& folder, const std::string& name, std::string_view extension) {
  const std::vector<std::string> names = shipped_names(folder, extension);
  return fmt::format("the path of a file that ends in {}, or one of {}{}", extension, fmt::join(names, ", "),
                     settings::did_you_mean(name, names));
}

}  // namespace

DescriptionFile read_description_file(std::string_view kind, const std::string& name_or_path,
                                      std::string_view extension) {
  const std::string folder = std::string(kind) + "s";
  const std::filesystem::path path = find_data_file(folder, name_or_path, extension);
  if (path.empty())
    throw DescriptionError(fmt::format("{0} \"{1}\": no such {0}; give {2}", kind, name_or_path,
                                       choices(folder, name_or_path, extension)));
  try {
    return {path.string(), read_limited_file(path, kMostDescriptionBytes)};
  } catch (const DescriptionError& error) {
    throw DescriptionError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

void require_description(std::string_view kind, const std::string& name_or_path, std::string_view extension) {
  const std::string folder = std::string(kind) + "s";
  if (find_data_file(folder, name_or_path, extension).empty())
    throw DescriptionError("must be " + choices(folder, name_or_path, extension));
}

}  // namespace kenaf::description
