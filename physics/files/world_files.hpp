// The files that a world names: looked up in the world's own folder and nowhere else.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace kenaf::physics {

class WorldFiles {
 public:
  static constexpr std::size_t kMostFileBytes = std::size_t{16} << 20U, kMostBytes = std::size_t{64} << 20U;

  // Empty: a world that may name no files.
  explicit WorldFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // The bytes of the file that `uri` names: "a/b.stl", "file://a/b.stl", "file:///folder/a/b.stl" or
  // "model://a/b.stl", where a is a folder within this one. Throws DescriptionError with what is wrong, without a
  // place: a path that leads out of the folder (through ".." or a link too), no regular file, more than 16 MiB, more
  // than 64 MiB with all read before.
  std::string read(const std::string& uri);

 private:
  std::filesystem::path folder_;
  std::size_t bytes_left_ = kMostBytes;
};

}  // namespace kenaf::physics
