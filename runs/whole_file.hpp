// Files that are whole or absent: written aside in `<file>.part`, then renamed.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace kenaf::runs {

// Replaces `file` by `bytes`, or leaves it as it was and throws RunFileError. Its folder must exist.
void write_whole_file(const std::filesystem::path& file, std::string_view bytes);

// All bytes of a file. Throws RunFileError where it cannot be read.
std::string read_whole_file(const std::filesystem::path& file);

// The steps of the same for a file that grows: open the part file, append to it, rename it. Each throws RunFileError.
int open_part_file(const std::filesystem::path& file);
void append_to_part_file(int descriptor, const std::filesystem::path& file, std::string_view bytes);
// Closes `descriptor` in every case.
void finish_part_file(int descriptor, const std::filesystem::path& file);

}  // namespace kenaf::runs
