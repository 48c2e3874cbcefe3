#include "gap/challenge/sha256.hpp"

#include <fmt/format.h>
#include <nettle/sha2.h>

#include <span>

#include "formats/runs/dataset.hpp"
#include "formats/runs/whole_file.hpp"
#include "gap/challenge/plan.hpp"

namespace kenaf::gap::challenge {
namespace {

class Hash {
 public:
  Hash() { sha256_init(&state_); }
  void add(std::string_view bytes) {
    sha256_update(&state_, bytes.size(), reinterpret_cast<const std::uint8_t*>(bytes.data()));
  }
  std::string hex() {
    std::uint8_t digest[SHA256_DIGEST_SIZE];
    sha256_digest(&state_, sizeof digest, digest);
    std::string text;
    for (const std::uint8_t byte : digest) text += fmt::format("{:02x}", byte);
    return text;
  }

 private:
  sha256_ctx state_;
};

}  // namespace

std::string sha256(std::string_view bytes) {
  Hash hash;
  hash.add(bytes);
  return hash.hex();
}

std::string sha256_of_dataset(const std::filesystem::path& folder) {
  Hash hash;
  const auto add = [&](const std::filesystem::path& file) {
    runs::read_in_chunks(file, [&](std::string_view bytes) { hash.add(bytes); });
  };
  for (const std::filesystem::path& dataset : {folder, folder / kBeforeFolder}) {
    if (dataset != folder && !std::filesystem::exists(dataset)) continue;
    add(dataset / "dataset.toml");
    for (const runs::DatasetRun& run : runs::read_dataset(dataset).runs) add(dataset / run.file);
  }
  return hash.hex();
}

}  // namespace kenaf::gap::challenge
