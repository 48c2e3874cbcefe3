#include "formats/description/limited_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "formats/description/description_error.hpp"

namespace kenaf::description {
namespace {

struct OpenFile {
  int descriptor;

  // Without O_NONBLOCK, opening a FIFO would wait for a writer.
  explicit OpenFile(const std::filesystem::path& path)
      : descriptor(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
  ~OpenFile() {
    if (descriptor >= 0) ::close(descriptor);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
};

[[noreturn]] void fail_reading() {
  throw DescriptionError(fmt::format("cannot be read: {}", std::generic_category().message(errno)));
}

std::string in_mib(std::size_t bytes) {
  constexpr unsigned kMib = 20;
  return bytes >> kMib > 0 ? fmt::format("{} MiB", bytes >> kMib) : fmt::format("{} bytes", bytes);
}

}  // namespace

std::string read_limited_file(const std::filesystem::path& path, std::size_t most_bytes) {
  // What is open is judged, not its path, which may name something else a moment later.
  const OpenFile file(path);
  struct stat status {};
  if (file.descriptor < 0 || ::fstat(file.descriptor, &status) != 0) fail_reading();
  if (!S_ISREG(status.st_mode)) throw DescriptionError("is a folder, device, pipe or socket, not a file");
  const std::string too_large = fmt::format("is larger than {}", in_mib(most_bytes));
  if (static_cast<std::size_t>(status.st_size) > most_bytes) throw DescriptionError(too_large);

  // Up to the end of the file, whose stated size may be wrong: files of /proc state 0.
  constexpr std::size_t kAtLeast = 4096;
  std::string bytes(std::max(kAtLeast, static_cast<std::size_t>(status.st_size) + 1), '\0');
  for (std::size_t have = 0;;) {
    if (have == bytes.size()) bytes.resize(2 * have);
    const ssize_t got = ::read(file.descriptor, bytes.data() + have, bytes.size() - have);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail_reading();
    have += static_cast<std::size_t>(got);
    if (have > most_bytes) throw DescriptionError(too_large);
    if (got > 0) continue;
    bytes.resize(have);
    return bytes;
  }
}

}  // namespace kenaf::description
