// Files that are complete or absent: written to `<file>.part`, then renamed.
//
// Thread safety: any thread; one writer of a file at a time, since two would share its part file.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace kenaf::runs {

// Replaces the content of `file` by `bytes`. Throws RunFileError if that fails; `file` is unchanged then, and no part
// file remains. Its folder must exist.
void write_whole_file(const std::filesystem::path& file, std::string_view bytes);

// Returns all bytes of a file. Throws RunFileError if it cannot be read.
std::string read_whole_file(const std::filesystem::path& file);

// The same piece by piece, in order.
void read_in_chunks(const std::filesystem::path& file, const std::function<void(std::string_view)>& take);

// The steps of write_whole_file() for a file that grows: open the part file, append to it, rename it. Each throws
// RunFileError.
int open_part_file(const std::filesystem::path& file);
void append_to_part_file(int descriptor, const std::filesystem::path& file, std::string_view bytes);
// Closes `descriptor` in every case.
void finish_part_file(int descriptor, const std::filesystem::path& file);

}  // namespace kenaf::runs
