// Finds runs that hold the same numbers as an earlier one. A copied file is no repeat: taken for one, it would say that
// robots repeat themselves to the last bit, and every difference from the simulation would count as a gap.
//
// Thread safety: a value; one thread at a time.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <unordered_map>

#include "formats/runs/run_file.hpp"
#include "gap/logs/plausibility.hpp"

namespace kenaf::gap::logs {

class KnownRuns {
 public:
  // Returns a warning if an earlier run has the same columns and values, to the last bit; otherwise remembers this one.
  // Compares hashes: among 10,000 runs the probability of a false match is 3e-12.
  std::optional<Finding> copy(const runs::Run& run, const std::string& file);

 private:
  std::unordered_map<std::size_t, std::string> file_of_;
};

}  // namespace kenaf::gap::logs
