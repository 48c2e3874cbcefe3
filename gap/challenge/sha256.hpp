// SHA-256 (FIPS 180-4), by which a challenge's key is committed to before it is shown.
//
// Thread safety: pure functions, but for what they read.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace kenaf::gap::challenge {

// 64 hexadecimal digits, as sha256sum prints them.
std::string sha256(std::string_view bytes);

// Of a dataset: of its dataset.toml and the runs that are in it, in order, and where one of before is in it
// (kBeforeFolder), of that likewise. Throws runs::RunFileError where one cannot be
// read.
std::string sha256_of_dataset(const std::filesystem::path& folder);

}  // namespace kenaf::gap::challenge
