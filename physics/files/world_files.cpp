#include "physics/files/world_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <string_view>
#include <system_error>

#include "physics/robot_description.hpp"

namespace kenaf::physics {
namespace {

namespace fs = std::filesystem;

std::string path_of(const std::string& uri) {
  for (const std::string_view scheme : {"file://", "model://"})
    if (uri.starts_with(scheme)) return uri.substr(scheme.size());
  const std::size_t colon = uri.find("://");
  if (colon != std::string::npos)
    throw description::DescriptionError(
        fmt::format("\"{}\": only file:// and model:// are read, no {}://", uri, uri.substr(0, colon)));
  return uri;
}

bool is_within(const fs::path& folder, const fs::path& file) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

}  // namespace

std::string WorldFiles::read(const std::string& uri) {
  const std::string path = path_of(uri);
  if (folder_.empty())
    throw description::DescriptionError(
        fmt::format("\"{}\": this world has no folder in which to look for files", uri));

  // Links are resolved before the comparison, so that they cannot lead out of the folder.
  std::error_code error;
  const fs::path folder = fs::canonical(folder_, error);
  const fs::path file = error ? fs::path() : fs::canonical(folder / path, error);
  if (!error && !is_within(folder, file))
    throw description::DescriptionError(
        fmt::format("\"{}\" is not in the world's folder {}, where all of its files must be", uri, folder.string()));
  if (error || !fs::is_regular_file(file, error))
    throw description::DescriptionError(
        fmt::format("\"{}\": there is no such file in the world's folder {}", uri, folder_.string()));

  // At most one byte more than is allowed is read, whatever the size says.
  std::ifstream in(file, std::ios::binary);
  const std::size_t most = std::min(kMostFileBytes, bytes_left_);
  std::string bytes(std::min<std::size_t>(fs::file_size(file, error), most + 1), '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!in || error)
    throw description::DescriptionError(fmt::format("\"{}\" cannot be read; check its permissions", uri));
  if (bytes.size() > most)
    throw description::DescriptionError(
        fmt::format("\"{}\" is too large: a file may have {} MiB, all of a world's files {} MiB", uri,
                    kMostFileBytes >> 20U, kMostBytes >> 20U));
  bytes_left_ -= bytes.size();
  return bytes;
}

}  // namespace kenaf::physics
