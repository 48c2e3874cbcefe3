#include "formats/runs/whole_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

#include "formats/runs/run_file.hpp"

namespace kenaf::runs {

namespace {

namespace fs = std::filesystem;

fs::path part_of(const fs::path& file) {
  return file.string() + ".part";
}

[[noreturn]] void fail(const fs::path& file, std::string_view what, int error) {
  throw RunFileError(file.string() + ": " + std::string(what) + ": " + std::generic_category().message(error));
}

}  // namespace

int open_part_file(const fs::path& file) {
  const int descriptor = ::open(part_of(file).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) fail(part_of(file), "cannot be created", errno);
  return descriptor;
}

void append_to_part_file(int descriptor, const fs::path& file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(part_of(file), "cannot be written", errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void finish_part_file(int descriptor, const fs::path& file) {
  // Without the sync a power cut could leave the new name on an empty file.
  const int sync_error = ::fsync(descriptor) == 0 || errno == EINVAL ? 0 : errno;
  const int close_error = ::close(descriptor) == 0 ? 0 : errno;
  if (sync_error != 0) fail(part_of(file), "cannot be written", sync_error);
  if (close_error != 0) fail(part_of(file), "cannot be written", close_error);
  std::error_code error;
  fs::rename(part_of(file), file, error);
  if (error) fail(file, "cannot be renamed from its part file", error.value());
}

void write_whole_file(const fs::path& file, std::string_view bytes) {
  const int descriptor = open_part_file(file);
  bool closed = false;
  try {
    append_to_part_file(descriptor, file, bytes);
    closed = true;
    finish_part_file(descriptor, file);
  } catch (...) {
    if (!closed) ::close(descriptor);
    std::error_code ignored;
    fs::remove(part_of(file), ignored);
    throw;
  }
}

void read_in_chunks(const fs::path& file, const std::function<void(std::string_view)>& take) {
  struct Closed {
    int descriptor;
    ~Closed() { ::close(descriptor); }
  };
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail(file, "cannot be opened", errno);
  const Closed closed{descriptor};
  std::array<char, 65536> chunk;
  ssize_t count = 0;
  while ((count = ::read(descriptor, chunk.data(), chunk.size())) > 0 || (count < 0 && errno == EINTR)) {
    if (count > 0) take({chunk.data(), static_cast<std::size_t>(count)});
  }
  if (count < 0) fail(file, "cannot be read", errno);
}

std::string read_whole_file(const fs::path& file) {
  std::string bytes;
  read_in_chunks(file, [&bytes](std::string_view chunk) { bytes.append(chunk); });
  return bytes;
}

}  // namespace kenaf::runs
