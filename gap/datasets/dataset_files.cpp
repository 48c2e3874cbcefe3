#include "gap/datasets/dataset_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "formats/runs/whole_file.hpp"

namespace kenaf::gap::datasets {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& folder, std::string_view what, int error) {
  throw std::runtime_error(fmt::format("{}: {}: {}", folder.string(), what, std::generic_category().message(error)));
}

constexpr std::string_view kPartFolder = ".part-";  // prefix of an incomplete folder's name

// Whether the folder is empty except for what a killed program left.
bool holds_nothing(const fs::path& folder) {
  return std::ranges::all_of(fs::directory_iterator(folder), [](const fs::directory_entry& entry) {
    return entry.path().filename().string().starts_with(kPartFolder);
  });
}

}  // namespace

void check_can_write(const fs::path& folder) {
  fs::path there = fs::absolute(folder).lexically_normal();
  while (!fs::exists(there) && there.has_relative_path()) there = there.parent_path();
  if (!fs::is_directory(there)) throw std::runtime_error(fmt::format("{}: is not a folder", there.string()));
  if (::access(there.c_str(), W_OK | X_OK) != 0) fail(there, "cannot be written into", errno);
}

PartFolder::PartFolder(const fs::path& out, bool force, std::string_view otherwise) : out_(out) {
  if (out.empty()) throw std::invalid_argument("no folder to write to; give one with --out");
  std::error_code error;
  const fs::file_status status = fs::status(out, error);
  if (fs::exists(status) && !fs::is_directory(status))
    throw std::runtime_error(fmt::format("{}: is not a folder", out.string()));
  if (!fs::status_known(status)) fail(out, "cannot be reached", error.value());
  const bool is_there = fs::exists(status);
  if (is_there && !force && !holds_nothing(out))
    throw std::runtime_error(fmt::format("{}: is not empty; give another folder{}", out.string(), otherwise));

  fs::path whole = fs::absolute(out).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();  // "runs/" is "runs"
  out_ = whole;
  if (!is_there) fs::create_directories(out_.parent_path(), error);
  if (error) fail(out, "cannot be created", error.value());
  // An existing folder gets the new one inside: it may be a link, a mount point or a working directory.
  std::string name = fmt::format("{}{}XXXXXX", is_there ? (out_ / "").string() : out_.string(), kPartFolder);
  if (::mkdtemp(name.data()) == nullptr) fail(out, "cannot be created", errno);
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
  if (!fs::exists(out_)) {
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

  // A file keeps its name; one that refers to other files cannot be copied and gets its full path.
  const auto [known, is_new] = names_.try_emplace(name_or_path, fs::path(name_or_path).stem().string() + extension_);
  if (!is_new) return known->second;
  const std::string text = runs::read_whole_file(name_or_path);
  if (text.find("<uri>") != text.npos) return known->second = fs::absolute(name_or_path).lexically_normal();

  // A file of that name in the folder must have the same contents.
  const fs::path copy = folder_ / known->second;
  const bool there = fs::exists(copy);
  if (known->second == "dataset.toml" || (there && runs::read_whole_file(copy) != text))
    throw std::runtime_error(fmt::format("{}: another file of the dataset has that name; rename it", name_or_path));
  if (!there) {
    runs::write_whole_file(copy, text);
    made_.push_back(copy);
  }
  return known->second;
}

}  // namespace kenaf::gap::datasets
