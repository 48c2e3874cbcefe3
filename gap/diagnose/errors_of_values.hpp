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
  bool also_without = true;             // also on a robot without the model's effects
};

// Standard errors of one value. Those of numbers come from so few robots that Student's t takes the place of the normal
// distribution.
struct ErrorOfValue {
  double of_noise = 0;    // and discrepancies
  double of_numbers = 0;  // with wrong values, on the robot with the model's effects
  // Likewise, on the robot without them; 0 against a baseline, and if it was not asked for. Where that one slides or
  // climbs and the other one does not, wrong numbers may do much more to it, and look like an effect.
  double of_numbers_without = 0;

  double half_width() const;  // of the 95 % interval
  // The distance from no effect that noise and numbers exceed as rarely as a normal distribution exceeds 4 sigma: once
  // in 16,000 times, as one effect of some 70 does by chance once in 200 diagnoses.
  double four_sigma() const;
};

// One for each of the model's values.
std::vector<ErrorOfValue> errors_of_values(const StageData& data, const StandingModel& standing,
                                           const NumbersOff& numbers, const Simulate& simulate, std::uint64_t seed);

// Widens the interval to +-`half_width` if that is wider, within the candidate's range.
Interval widened(Interval interval, double half_width, const candidates::Candidate& candidate);

}  // namespace kenaf::gap::diagnose
