#include "formats/description/data_files.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <map>
#include <system_error>

namespace kenaf::description {

namespace fs = std::filesystem;

namespace {

// An install prefix has its libraries in lib/ or, on Debian, in lib/x86_64-linux-gnu/, and modules of Python in
// lib/python3.11/dist-packages/kenaf/.
constexpr int kDepthOfLibraries = 4;

// The shared library or program that holds this code.
fs::path own_file() {
  Dl_info info{};
  return dladdr(reinterpret_cast<const void*>(&data_roots), &info) != 0 ? fs::path(info.dli_fname) : fs::path();
}

}  // namespace

std::vector<fs::path> data_roots() {
  std::vector<fs::path> roots;
  if (const char* set = std::getenv("KENAF_DATA_DIR"); set != nullptr && *set != '\0') roots.emplace_back(set);
  std::error_code ignored;
  if (const fs::path program = fs::read_symlink("/proc/self/exe", ignored); !program.empty()) {
    roots.push_back(program.parent_path().parent_path() / "share" / "kenaf");
  }
  // For libkenaf_real and the Python modules in a user's program, which may be anywhere.
  if (const fs::path library = fs::weakly_canonical(own_file(), ignored); !library.empty()) {
    fs::path prefix = library.parent_path();
    for (int up = 0; up < kDepthOfLibraries; ++up) {
      prefix = prefix.parent_path();
      roots.push_back(prefix / "share" / "kenaf");
    }
  }
  return roots;
}

fs::path find_data_file(std::string_view folder, const std::string& name, std::string_view extension) {
  if (name.find('/') != std::string::npos || name.ends_with(extension)) return name;

  const std::string file_name = name + std::string(extension);
  std::error_code ignored;
  for (const fs::path& root : data_roots()) {
    fs::path candidate = root / folder / file_name;
    if (fs::is_regular_file(candidate, ignored)) return candidate;
  }
  return {};
}

std::vector<fs::path> list_data_files(std::string_view folder, std::string_view extension) {
  std::map<std::string, fs::path> by_name;
  for (const fs::path& root : data_roots()) {
    std::error_code no_such_folder;
    for (const fs::directory_entry& entry : fs::directory_iterator(root / folder, no_such_folder)) {
      if (entry.path().extension() == extension) by_name.emplace(entry.path().filename(), entry.path());
    }
  }
  std::vector<fs::path> files;
  for (const auto& [name, path] : by_name) files.push_back(path);
  return files;
}

}  // namespace kenaf::description
