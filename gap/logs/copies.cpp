#include "gap/logs/copies.hpp"

#include <fmt/format.h>

#include <functional>
#include <string_view>

namespace kenaf::gap {
namespace {

// As boost::hash_combine of 64 bits.
void mix(std::size_t& hash, std::size_t with) {
  hash ^= with + 0x9e3779b97f4a7c15 + (hash << 6) + (hash >> 2);
}

std::size_t hash_of(const runs::Run& run) {
  std::size_t hash = 0;
  for (const std::string& name : run.columns) mix(hash, std::hash<std::string>()(name));
  for (const std::vector<double>& column : run.values) {
    const auto* bytes = reinterpret_cast<const char*>(column.data());
    mix(hash, std::hash<std::string_view>()({bytes, column.size() * sizeof(double)}));
  }
  return hash;
}

}  // namespace

std::optional<Finding> KnownRuns::copy(const runs::Run& run, const std::string& file) {
  const auto [known, is_new] = file_of_.try_emplace(hash_of(run), file);
  if (is_new) return std::nullopt;
  return Finding{Finding::Severity::warn, file, 0, "",
                 fmt::format("holds the same numbers as {}; a copy is no repeat", known->second)};
}

}  // namespace kenaf::gap
