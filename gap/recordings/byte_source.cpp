#include "gap/recordings/byte_source.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <system_error>

#include "gap/recordings/recording_error.hpp"

namespace kenaf::gap::recordings {
namespace {

void check_range(std::uint64_t size, std::uint64_t offset, std::uint64_t count) {
  if (offset > size || count > size - offset)
    throw RecordingError(fmt::format("{} bytes at byte {} are beyond the end, at byte {}", count, offset, size));
}

class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& file)
      : name_(file.string()), descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (descriptor_ < 0) fail("cannot be opened");
  }
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  std::uint64_t size() const {
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0) fail("cannot be read");
    return static_cast<std::uint64_t>(status.st_size);
  }
  void read(std::uint64_t offset, std::span<char> into) const {
    while (!into.empty()) {
      const ssize_t count = ::pread(descriptor_, into.data(), into.size(), static_cast<off_t>(offset));
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) fail("cannot be read");
      if (count == 0) throw RecordingError(name_ + ": became shorter while it was read");
      into = into.subspan(static_cast<std::size_t>(count));
      offset += static_cast<std::uint64_t>(count);
    }
  }

 private:
  [[noreturn]] void fail(const char* what) const {
    throw RecordingError(fmt::format("{}: {}: {}", name_, what, std::generic_category().message(errno)));
  }
  std::string name_;
  int descriptor_;
};

}  // namespace

ByteSource bytes_of_file(const std::filesystem::path& file) {
  const auto open = std::make_shared<OpenFile>(file);
  const std::uint64_t size = open->size();
  return {size, [open, size](std::uint64_t offset, std::span<char> into) {
            check_range(size, offset, into.size());
            open->read(offset, into);
          }};
}

ByteSource bytes_in_memory(std::string bytes) {
  const auto held = std::make_shared<const std::string>(std::move(bytes));
  return {held->size(), [held](std::uint64_t offset, std::span<char> into) {
            check_range(held->size(), offset, into.size());
            if (!into.empty()) std::memcpy(into.data(), held->data() + offset, into.size());
          }};
}

std::string read_bytes(const ByteSource& source, std::uint64_t offset, std::uint64_t count) {
  check_range(source.size, offset, count);
  std::string bytes(count, '\0');
  source.read(offset, bytes);
  return bytes;
}

std::string_view ReadAhead::at(std::uint64_t offset, std::uint64_t count) {
  check_range(source_.size, offset, count);
  const bool inside = offset >= begin_ && offset - begin_ + count <= window_.size();
  if (!inside) {
    window_.resize(std::min(std::max(count, kMost), source_.size - offset));
    source_.read(offset, window_);
    begin_ = offset;
  }
  return std::string_view(window_).substr(offset - begin_, count);
}

}  // namespace kenaf::gap::recordings
