// How a dataset gets onto the disk: all of it or nothing, descriptions that are files with it.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::gap::datasets {

// Throws std::runtime_error in words where nothing can be written into `folder`, or it cannot be made. For asking
// before something long is calculated; makes nothing.
void check_can_write(const std::filesystem::path& folder);

// A folder beside `out`, or within it where it is there, that becomes `out` when it is whole, and goes away when it
// never gets so.
class PartFolder {
 public:
  // Throws std::exception in words: no folder can be there, or `out` is one that is not empty and `force` is not set;
  // `otherwise` says what to do then but take another folder.
  PartFolder(const std::filesystem::path& out, bool force, std::string_view otherwise = {});
  ~PartFolder();
  PartFolder(const PartFolder&) = delete;
  PartFolder& operator=(const PartFolder&) = delete;

  const std::filesystem::path& path() const { return part_; }
  // Replaces files of the same names where `out` holds some. dataset.toml comes last, so that it never names a run that
  // is not there.
  void finish();

 private:
  std::filesystem::path out_, part_;
};

// What a dataset calls a description: a shipped name, or the copy of a file that it keeps beside dataset.toml. A world
// of meshes or height maps stays where they are, under its full path.
class Descriptions {
 public:
  Descriptions(std::filesystem::path folder, std::string extension);

  // Copies a file into the folder, once. Throws where a file with other contents has its name there.
  std::string add(const std::string& name_or_path);
  const std::vector<std::filesystem::path>& made() const { return made_; }  // the copies that were not there before

 private:
  std::filesystem::path folder_;
  std::string extension_;
  std::map<std::string, std::string> names_;
  std::vector<std::filesystem::path> made_;
};

}  // namespace kenaf::gap::datasets
