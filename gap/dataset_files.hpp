// How a dataset gets onto the disk: all of it or nothing, descriptions that are files with it.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace kenaf::gap {

// A folder beside `out` that becomes `out` when it is whole, and goes away when it never gets so.
class PartFolder {
 public:
  // Throws std::exception in words: no folder can be there, or `out` is one that is not empty and `force` is not set.
  PartFolder(const std::filesystem::path& out, bool force);
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

 private:
  std::filesystem::path folder_;
  std::string extension_;
  std::map<std::string, std::string> names_;
};

}  // namespace kenaf::gap
