// SHA-256 (FIPS 180-4), which commits to a challenge's key before it is shown.
//
// Thread safety: pure functions, except for the files they read.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace kenaf::gap::challenge {

// 64 hexadecimal digits, as sha256sum prints them.
std::string sha256(std::string_view bytes);

// Hash of a dataset: of its dataset.toml and its runs, in order, then likewise of the earlier dataset in it
// (kBeforeFolder), if there is one. Throws runs::RunFileError if a file cannot be read.
std::string sha256_of_dataset(const std::filesystem::path& folder);

}  // namespace kenaf::gap::challenge
