#include "gap/logs/copies.hpp"

#include <fmt/format.h>

#include <boost/container_hash/hash.hpp>

namespace kenaf::gap::logs {

std::optional<Finding> KnownRuns::copy(const runs::Run& run, const std::string& file) {
  std::size_t hash = 0;
  boost::hash_combine(hash, run.columns);
  boost::hash_combine(hash, run.values);
  const auto [known, is_new] = file_of_.try_emplace(hash, file);
  if (is_new) return std::nullopt;
  return Finding{Finding::Severity::warn, file, 0, "",
                 fmt::format("contains the same numbers as {}; a copy is not a repeat", known->second)};
}

}  // namespace kenaf::gap::logs
