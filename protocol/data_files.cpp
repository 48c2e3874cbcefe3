#include "protocol/data_files.hpp"

#include <cstdlib>
#include <system_error>
#include <vector>

namespace kenaf {

namespace fs = std::filesystem;

fs::path find_data_file(std::string_view folder, const std::string& name, std::string_view extension) {
  if (name.find('/') != std::string::npos || name.ends_with(extension)) return name;

  std::vector<fs::path> roots;
  if (const char* set = std::getenv("KENAF_DATA_DIR"); set != nullptr && *set != '\0') roots.emplace_back(set);
  std::error_code ignored;
  if (const fs::path program = fs::read_symlink("/proc/self/exe", ignored); !program.empty()) {
    roots.push_back(program.parent_path().parent_path() / "share" / "kenaf");
  }
  roots.emplace_back(KENAF_SOURCE_DATA_DIR);

  const std::string file_name = name + std::string(extension);
  for (const fs::path& root : roots) {
    fs::path candidate = root / folder / file_name;
    if (fs::is_regular_file(candidate, ignored)) return candidate;
  }
  return {};
}

}  // namespace kenaf
