// How wrong a model's values are where numbers of the description are a little off: by a parametric bootstrap (Efron
// and Tibshirani 1993, An Introduction to the Bootstrap, ch. 6.5).
//
// The likelihood has numbers shift what is measured along straight lines, each for itself. Where they shift it by a
// hundred times the noise, what several do together, and what they do to an effect, is far above the noise as well: a
// gyro on a body that turns faster than the described one shows a delay that is too long. So robots are drawn whose
// numbers are off, simulated, and their values estimated as those of the measured one are.
//
// Thread safety: pure functions apart from what the simulator does. Deterministic for a seed.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "gap/diagnose/effect_values.hpp"
#include "gap/diagnose/side_by_side.hpp"

namespace kenaf::gap::diagnose {

// Numbers of the description that are off.
struct NumbersOff {
  std::vector<std::size_t> candidates;  // none of them with a value in the model
  double sigma = 0;                     // in parts of Candidate::whole
  bool also_before = false;             // in a baseline that the data are measured against
};

// Standard error of each of the model's values by noise, discrepancies, and numbers that are off.
Eigen::VectorXd errors_of_values(const StageData& data, const StandingModel& standing, const NumbersOff& numbers,
                                 const Simulate& simulate, std::uint64_t seed);

// At least as wide as a standard error makes it, within the candidate's range.
Interval widened(Interval interval, double standard_error, const candidates::Candidate& candidate);

}  // namespace kenaf::gap::diagnose
