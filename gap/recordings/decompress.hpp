// Unpacks what recorders compress, with memory that grows with what is really there, not with what the file says.
//
// Thread safety: pure functions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace kenaf::gap::recordings {

enum class Compression { none, lz4, zstd, bz2 };

// The most that is unpacked at once, chosen: recorders write pieces of 1 to 4 MB, or of one message that is larger.
inline constexpr std::uint64_t kLargestBlock = std::uint64_t{1} << 28;

// By the name in a file: "", "none", "lz4" (frames), "zstd", "bz2". Empty if there is no such one.
std::optional<Compression> compression_of(std::string_view name);

// Throws RecordingError if the bytes are damaged, or unpack to another size or to more than kLargestBlock.
std::string decompressed(Compression compression, std::string_view bytes, std::uint64_t size);
// The same of an unknown size.
std::string decompressed(Compression compression, std::string_view bytes);

bool begins_as_zstd(std::string_view bytes);

// Unpacks a whole file of zstd into another one, piece by piece. Throws RecordingError.
void decompress_zstd_file(const std::filesystem::path& from, const std::filesystem::path& to);

// Packs with zstd.
std::string compressed_zstd(std::string_view bytes);

}  // namespace kenaf::gap::recordings
