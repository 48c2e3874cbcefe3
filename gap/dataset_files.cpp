#include "gap/dataset_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "runs/whole_file.hpp"

namespace kenaf::gap {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& folder, std::string_view what, int error) {
  throw std::runtime_error(fmt::format("{}: {}: {}", folder.string(), what, std::generic_category().message(error)));
}

}  // namespace

PartFolder::PartFolder(const fs::path& out, bool force) : out_(out) {
  if (out.empty()) throw std::invalid_argument("no folder to write to; give one with --out");
  std::error_code error;
  const fs::file_status status = fs::status(out, error);
  if (fs::exists(status) && !fs::is_directory(status))
    throw std::runtime_error(fmt::format("{}: is no folder", out.string()));
  if (!fs::status_known(status)) fail(out, "cannot be reached", error.value());
  if (fs::exists(status)) {
    const bool empty = fs::is_empty(out, error);
    if (error) fail(out, "cannot be read", error.value());
    if (!empty && !force)
      throw std::runtime_error(
          fmt::format("{}: is not empty; give another folder, or --force to write into it", out.string()));
  }
  fs::path whole = fs::absolute(out).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();  // "runs/" is "runs"
  out_ = whole;
  fs::create_directories(out_.parent_path(), error);
  if (error) fail(out, "cannot be made", error.value());
  std::string name = out_.string() + ".part-XXXXXX";
  if (::mkdtemp(name.data()) == nullptr) fail(out, "cannot be made", errno);
  part_ = name;
  fs::permissions(part_,
                  fs::perms::group_read | fs::perms::group_exec | fs::perms::others_read | fs::perms::others_exec,
                  fs::perm_options::add);
}

PartFolder::~PartFolder() {
  std::error_code ignored;
  fs::remove_all(part_, ignored);
}

void PartFolder::finish() {
  if (!fs::exists(out_) || fs::is_empty(out_)) {
    fs::rename(part_, out_);
    return;
  }
  const auto move = [this](const fs::path& file) { fs::rename(file, out_ / file.filename()); };
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(part_)) files.push_back(entry.path());
  for (const fs::path& file : files)
    if (file.filename() != "dataset.toml") move(file);
  move(part_ / "dataset.toml");
}

Descriptions::Descriptions(fs::path folder, std::string extension)
    : folder_(std::move(folder)), extension_(std::move(extension)) {}

std::string Descriptions::add(const std::string& name_or_path) {
  const bool path = name_or_path.find('/') != name_or_path.npos || name_or_path.ends_with(extension_);
  if (!path) return name_or_path;
  const auto [known, is_new] = names_.try_emplace(name_or_path, fs::path(name_or_path).stem().string() + extension_);
  if (!is_new) return known->second;
  const std::string text = runs::read_whole_file(name_or_path);
  if (text.find("<uri>") != text.npos) return known->second = fs::absolute(name_or_path).lexically_normal();
  const fs::path copy = folder_ / known->second;
  const bool there = fs::exists(copy);
  if (known->second == "dataset.toml" || (there && runs::read_whole_file(copy) != text))
    throw std::runtime_error(fmt::format("{}: another file of the dataset has that name; rename it", name_or_path));
  if (!there) runs::write_whole_file(copy, text);
  return known->second;
}

}  // namespace kenaf::gap
