// The files that a world refers to, read from the world's own folder and nowhere else.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace kenaf::physics {

class WorldFiles {
 public:
  static constexpr std::size_t kMostFileBytes = std::size_t{16} << 20U;
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20U;  // of all files together

  // `folder` empty: the world may not refer to files.
  explicit WorldFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // Returns the bytes of the file that `uri` names: "a/b.stl", "file://a/b.stl", "file:///folder/a/b.stl" or
  // "model://a/b.stl", where a is a folder within this one. Throws DescriptionError (without a place) if the path leads
  // out of the folder (also through ".." or a link), is no regular file, has more than 16 MiB, or more than 64 MiB
  // together with all files read before.
  std::string read(const std::string& uri);

 private:
  std::filesystem::path folder_;
  std::size_t bytes_left_ = kMostBytes;
};

}  // namespace kenaf::physics
