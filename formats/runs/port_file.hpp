// The file by which a server tells scripts and tests which port it has got: the port in decimal digits and a line feed.
//
// Thread safety: any thread; one writer of a file at a time.
#pragma once

#include <cstdint>
#include <filesystem>

namespace kenaf::runs {

// Writes `port`, 1 to 65535, as write_whole_file() does: whoever waits for the file finds the whole number or no file.
// Call it once the server listens. Throws RunFileError with the file's name if it cannot be written; its folder must
// exist.
void write_port_file(const std::filesystem::path& path, std::uint16_t port);

}  // namespace kenaf::runs
