// Errors of a model's values due to small errors of the description's numbers: by a parametric bootstrap (Efron and
// Tibshirani 1993, An Introduction to the Bootstrap, ch. 6.5).
//
// The likelihood is linear in each number's error. Where these shift the measurements by a hundred times the noise,
// their interactions with each other and with effects are far above the noise, too: a gyro on a body that turns faster
// than described shows too long a delay. So robots with wrong numbers are drawn and simulated, and their values are
// estimated like those of the measured robot.
//
// Thread safety: pure functions, except that the simulator runs. Deterministic for a seed.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "gap/diagnose/effect_values.hpp"
#include "gap/diagnose/side_by_side.hpp"

namespace kenaf::gap::diagnose {

// Numbers of the description with errors.
struct NumbersOff {
  std::vector<std::size_t> candidates;  // none of them with a value in the model
  double sigma = 0;                     // as a fraction of Candidate::whole
  bool also_before = false;             // also in the baseline that the data are compared with
};

// Standard error of each of the model's values due to noise, discrepancies and wrong numbers.
Eigen::VectorXd errors_of_values(const StageData& data, const StandingModel& standing, const NumbersOff& numbers,
                                 const Simulate& simulate, std::uint64_t seed);

// Widens the interval to +-kHalfWidth standard errors if that is wider, within the candidate's range.
Interval widened(Interval interval, double standard_error, const candidates::Candidate& candidate);

}  // namespace kenaf::gap::diagnose
