// Runs that hold the same numbers as one before. A file that was copied is no repeat: taken for one, it would say that
// robots repeat themselves to the last bit, and every difference from the simulation would be a gap.
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
  // A warning where a run before this one has the same columns and values, to the last bit; else nothing, and this one
  // is known from then on. By hash: among 10,000 runs two others are taken for each other with a chance of 3e-12.
  std::optional<Finding> copy(const runs::Run& run, const std::string& file);

 private:
  std::unordered_map<std::size_t, std::string> file_of_;
};

}  // namespace kenaf::gap::logs
