#include "physics/files/world_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <system_error>

#include "formats/description/description_error.hpp"
#include "formats/description/limited_file.hpp"

namespace kenaf::physics {
namespace {

namespace fs = std::filesystem;
using description::DescriptionError;

constexpr std::string_view kOfModels = "model://", kOfFiles = "file://";

std::string path_of(const std::string& uri) {
  if (!WorldFiles::is_local(uri))
    throw DescriptionError(
        fmt::format("\"{}\": only file:// and model:// are read, no {}://", uri, uri.substr(0, uri.find("://"))));
  for (const std::string_view scheme : {kOfFiles, kOfModels})
    if (uri.starts_with(scheme)) return uri.substr(scheme.size());
  return uri;
}

bool is_within(const fs::path& folder, const fs::path& file) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

// The x of a version 1.x of SDF; nothing for what is no such version.
std::optional<int> minor_version(std::string_view version) {
  int minor = 0;
  if (!version.starts_with("1.")) return std::nullopt;
  if (std::from_chars(version.begin() + 2, version.end(), minor).ec != std::errc()) return std::nullopt;
  return minor;
}

// The file that a model.config names for the newest SDF that is read here; else the first that it names.
std::string file_in_config(const std::string& text) {
  constexpr int kNewest = 9;
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) return "";
  const tinyxml2::XMLElement* model = document.FirstChildElement("model");
  std::string best;
  int best_minor = -1;
  for (const auto* sdf = model ? model->FirstChildElement("sdf") : nullptr; sdf; sdf = sdf->NextSiblingElement("sdf")) {
    const char* file = sdf->GetText();
    const char* version = sdf->Attribute("version");
    const int minor = minor_version(version ? version : "").value_or(-1);
    if (!file || (!best.empty() && (minor > kNewest || minor <= best_minor))) continue;
    best = file;
    best_minor = minor > kNewest ? -1 : minor;
  }
  return best;
}

}  // namespace

WorldFiles::WorldFiles(std::string world_file, const fs::path& own, const std::vector<fs::path>& search)
    : world_file_(std::move(world_file)) {
  std::vector<fs::path> folders{own};
  folders.insert(folders.end(), search.begin(), search.end());
  for (const fs::path& folder : folders) {
    std::error_code error;
    const fs::path canonical = folder.empty() ? fs::path() : fs::canonical(folder, error);
    if (!error && fs::is_directory(canonical, error)) folders_.push_back(canonical);
  }
}

bool WorldFiles::is_local(const std::string& uri) {
  return uri.find("://") == std::string::npos || uri.starts_with(kOfFiles) || uri.starts_with(kOfModels);
}

std::string WorldFiles::folders_in_words() const {
  std::vector<std::string> names;
  for (const fs::path& folder : folders_) names.push_back(folder.string());
  return fmt::format("{}", fmt::join(names, ", "));
}

bool WorldFiles::is_allowed(const fs::path& canonical) const {
  return std::ranges::any_of(folders_, [&](const fs::path& folder) { return is_within(folder, canonical); });
}

std::optional<fs::path> WorldFiles::look_for(const std::string& uri, const std::string& named_in) const {
  const fs::path path = path_of(uri);
  if (!has_folders())
    throw DescriptionError(fmt::format("\"{}\": this world has no folder in which to look for files", uri));

  // Where to look; a joined path that is absolute stays itself.
  std::vector<fs::path> bases = folders_;
  if (!uri.starts_with(kOfModels) && named_in != world_file_)
    bases.insert(bases.begin(), fs::path(named_in).parent_path());

  // Links are resolved before the comparison, so that they cannot lead out of the folders.
  bool is_outside = false;
  for (const fs::path& base : bases) {
    std::error_code error;
    const fs::path found = fs::canonical(base / path, error);
    if (error) continue;
    if (is_allowed(found)) return found;
    is_outside = true;
  }
  if (is_outside)
    throw DescriptionError(fmt::format("\"{}\" is not in a folder of this world: {}; KENAF_WORLD_PATH names more", uri,
                                       folders_in_words()));
  return std::nullopt;
}

fs::path WorldFiles::find(const std::string& uri, const std::string& named_in) const {
  if (const std::optional<fs::path> found = look_for(uri, named_in)) return *found;
  throw DescriptionError(
      fmt::format("\"{}\": there is no such file in {}; KENAF_WORLD_PATH names more folders", uri, folders_in_words()));
}

std::string WorldFiles::read_at_most(const fs::path& file, std::size_t most_bytes) {
  const std::size_t most = std::min(most_bytes, bytes_left_);
  std::string bytes;
  try {
    bytes = description::read_limited_file(file, most);
  } catch (const DescriptionError& error) {
    const char* what_is_left = most < most_bytes ? ", what is left of the 64 MiB of all of a world's files" : "";
    throw DescriptionError(fmt::format("\"{}\" {}{}", file.string(), error.what(), what_is_left));
  }
  bytes_left_ -= bytes.size();
  return bytes;
}

fs::path WorldFiles::model_in(const fs::path& folder) {
  std::error_code error;
  const fs::path config = fs::canonical(folder / "model.config", error);
  std::string name = "model.sdf";
  if (!error) {
    if (!is_allowed(config))
      throw DescriptionError(fmt::format("{} is not in a folder of this world", (folder / "model.config").string()));
    name = file_in_config(read_at_most(config, kMostConfigBytes));
    if (name.empty())
      throw DescriptionError(fmt::format("{} names no model: it needs an <sdf> in its <model>", config.string()));
  }
  fs::path file = fs::canonical(folder / name, error);
  if (error) throw DescriptionError(fmt::format("{} holds no {}", folder.string(), name));
  if (!is_allowed(file))
    throw DescriptionError(fmt::format("{} is not in a folder of this world", (folder / name).string()));
  return file;
}

std::optional<fs::path> WorldFiles::find_model(const std::string& uri, const std::string& named_in) {
  std::optional<fs::path> found = look_for(uri, named_in);
  std::error_code error;
  if (!found || !fs::is_directory(*found, error)) return found;
  fs::path& model = models_[*found];
  if (model.empty()) model = model_in(*found);
  return model;
}

}  // namespace kenaf::physics
