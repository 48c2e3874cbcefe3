// Makes a run of the samples of a recording, as its mapping says.
//
// Thread safety: pure functions.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/runs/run_file.hpp"
#include "gap/recordings/mapping.hpp"
#include "gap/recordings/samples.hpp"

namespace kenaf::gap::recordings {

struct MadeRun {
  runs::Run run;                     // columns in the order of robot/columns.hpp, others behind them
  std::vector<std::string> remarks;  // "track_left_mps: 12 of 2000 rows are empty"
};

// The rows have the times of Mapping::rows, the first is 0. `gauge_m` is of drives that give none. Throws
// RecordingError if nothing has a value at the rows' source, a drive has no gauge, no row has a pose, another axis than
// z of the pose certainly points up and the mapping does not say which, or the run has more than 2^24 values.
MadeRun make_run(const Mapping& mapping, const Collected& collected, std::optional<double> gauge_m);

// Values at the rows' times by a rule; NaN where there is none. `wraps`: an angle, in radians, that jumps at pi and is
// returned in (-pi, pi].
std::vector<double> sampled(const Samples& samples, std::span<const double> rows_s, const Timing& timing, bool wraps);

}  // namespace kenaf::gap::recordings
