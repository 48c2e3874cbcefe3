#include "server/live/assets.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>

#include "formats/description/data_files.hpp"

namespace kenaf::live {

namespace fs = std::filesystem;

namespace {

std::string_view type_of(const fs::path& file) {
  const std::string extension = file.extension();
  if (extension == ".html") return "text/html; charset=utf-8";
  if (extension == ".css") return "text/css; charset=utf-8";
  if (extension == ".js") return "text/javascript; charset=utf-8";
  if (extension == ".svg") return "image/svg+xml";
  return {};
}

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw std::runtime_error("cannot read " + path.string());
  return bytes;
}

void add(Assets& assets, const std::string& path, const fs::path& file) {
  if (const std::string_view type = type_of(file); !type.empty()) assets[path] = {type, read_file(file)};
}

fs::path find_page() {
  for (const fs::path& root : description::data_roots())
    if (fs::is_regular_file(root / "page" / "index.html")) return root / "page";
  throw std::runtime_error("the page is not installed: there is no page/index.html below share/kenaf");
}

// three.js, from the folder beside the page's: `path` is that of the page's imports.
void add_three_file(Assets& assets, const fs::path& page, const std::string& path) {
  const fs::path file = page.parent_path() / path.substr(1);
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) {
    throw std::runtime_error("the page lacks three.js: there is no file " + file.string() +
                             "; install Kenaf again, or Debian's package libjs-three");
  }
  add(assets, path, file);
}

}  // namespace

Assets load_assets(std::string_view first_page) {
  const fs::path page = find_page();
  Assets assets;
  for (const fs::directory_entry& entry : fs::directory_iterator(page)) {
    const std::string name = entry.path().filename();
    if (entry.is_regular_file() && entry.path().extension() != ".html") add(assets, "/" + name, entry.path());
  }
  add(assets, "/", page / first_page);
  // At the paths by which the second imports the first.
  add_three_file(assets, page, "/three/build/three.module.js");
  add_three_file(assets, page, "/three/examples/jsm/controls/OrbitControls.js");
  return assets;
}

}  // namespace kenaf::live
