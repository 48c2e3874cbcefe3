// Bytes that are read where they are wanted, so that of a long file only a piece is in memory.
//
// Thread safety: one thread at a time uses a source.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace kenaf::gap::recordings {

struct ByteSource {
  std::uint64_t size = 0;
  // Fills `into` from `offset`. Throws RecordingError if that is not all within `size`, or cannot be read.
  std::function<void(std::uint64_t offset, std::span<char> into)> read;
};

// Throws RecordingError with the file's name if it cannot be opened. The file stays open as long as the source lives.
ByteSource bytes_of_file(const std::filesystem::path& file);
ByteSource bytes_in_memory(std::string bytes);

// Throws RecordingError before it allocates anything if the range is not within the source.
std::string read_bytes(const ByteSource& source, std::uint64_t offset, std::uint64_t count);

// Reads the heads of records one after the other with few reads of the source.
class ReadAhead {
 public:
  explicit ReadAhead(const ByteSource& source) : source_(source) {}
  // At most kMost bytes; valid until the next call. Throws as read_bytes().
  std::string_view at(std::uint64_t offset, std::uint64_t count);
  static constexpr std::uint64_t kMost = 1 << 16;

 private:
  const ByteSource& source_;
  std::uint64_t begin_ = 0;
  std::string window_;
};

}  // namespace kenaf::gap::recordings
