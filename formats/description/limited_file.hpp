// Reads a whole file that may come from anywhere. Thread safety: a pure function.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace kenaf::description {

// Returns the bytes of a regular file; links are followed. Returns at once whatever the path names: a FIFO is not
// waited for, a device is not read, and of a file that is too large nothing is read. Throws DescriptionError, which
// says what is wrong but not where ("is larger than 16 MiB"), if the path names no regular file, if the file cannot be
// read, or if it has more than `most_bytes`, also if it grows while it is read.
std::string read_limited_file(const std::filesystem::path& path, std::size_t most_bytes);

}  // namespace kenaf::description
