// Writes a dataset to disk, all of it or nothing, with the descriptions that are files.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::gap::datasets {

// Throws std::runtime_error with words for the user if `folder` cannot be written into or created. To be called before
// a long calculation; creates nothing.
void check_can_write(const std::filesystem::path& folder);

// A folder beside `out`, or within it if it exists, that becomes `out` when it is complete and is removed if it is
// never completed.
class PartFolder {
 public:
  // Throws std::exception with words for the user if the folder cannot be created, or `out` is not empty and `force` is
  // not set; `otherwise` then names what to do other than take another folder.
  PartFolder(const std::filesystem::path& out, bool force, std::string_view otherwise = {});
  ~PartFolder();
  PartFolder(const PartFolder&) = delete;
  PartFolder& operator=(const PartFolder&) = delete;

  const std::filesystem::path& path() const { return part_; }
  // Replaces files of the same names in `out`. dataset.toml comes last, so that it never names a missing run.
  void finish();

 private:
  std::filesystem::path out_, part_;
};

// The names of descriptions in a dataset: a shipped name, or the copy of a file beside dataset.toml. A world with
// meshes or height maps is not copied, but named by its full path.
class Descriptions {
 public:
  Descriptions(std::filesystem::path folder, std::string extension);

  // Copies a file into the folder, once, and returns its name. Throws if a file with other contents has that name
  // there.
  std::string add(const std::string& name_or_path);
  const std::vector<std::filesystem::path>& made() const { return made_; }  // the copies that are new

 private:
  std::filesystem::path folder_;
  std::string extension_;
  std::map<std::string, std::string> names_;
  std::vector<std::filesystem::path> made_;
};

}  // namespace kenaf::gap::datasets
