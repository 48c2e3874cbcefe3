// What is left of a gap, in words: which measured quantities it goes with, and which numbers and effects that points
// to.
//
// A model that leaves something unexplained leaves it in some pattern: a turn that is always too small, a speed that
// comes late, a current with an offset. Measured minus simulated is regressed on what was measured and simulated, a few
// terms for each channel, each of which has to hold on runs that its fit has not seen.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "gap/diagnose/features.hpp"
#include "gap/diagnose/observation.hpp"

namespace kenaf::gap::diagnose {

// What is left of one stage's gap in one run. The pointers must outlive the call.
struct LeftOverRun {
  const Observation* observation;
  const FeatureMap* features;  // of channels that were measured and are simulated
  Eigen::VectorXd measured,
      simulated;          // of each of features->bins(), in the channels' units; simulated: of the best model
  Eigen::VectorXd sigma;  // of each bin: noise, 1 sigma, in the channels' units
  std::size_t group;      // of repeats; runs of a group are held out together
};

// One term of the fit of one channel.
struct Dependence {
  std::string channel;      // "yaw rate"; a pose is told as its rates, forward, sideways and about the vertical
  std::string on;           // "simulated yaw rate", "time since the start"; "run" where runs differ from each other
  double share;             // of what is left in that channel beyond noise, on runs held out, 0 to 1
  double slope, intercept;  // of the channel's left-over over `on`: the line through `points`
  std::string words;        // one sentence, without a full stop
  std::vector<std::string> look_at;  // keys of the description and effects: "track.separation_m", "friction_across"
  std::vector<std::array<double, 2>> points{};  // (on, left-over without the channel's other terms), at most 400
  std::string on_unit{}, unit{};                // of the points' two numbers; may be empty
};

// A term is told where it takes this share of the squared left-over beyond noise on runs held out (chosen: less is no
// lead).
inline constexpr double kLeastTold = 0.1;

// The terms of all channels, largest share of its channel first; at most three of each channel, and one more that says
// how runs differ. Empty where nothing is left beyond noise, or it goes with nothing that was measured. `of_drives`: of
// track speeds, currents and voltage, as for the way from command to drive; else of pose and gyro, as for that to the
// body.
//
// `runs` may be empty. Vectors have as many numbers as features->bins(); throws std::invalid_argument where they have
// not.
//
// Deterministic.
std::vector<Dependence> describe_left_over(std::span<const LeftOverRun> runs, bool of_drives);

}  // namespace kenaf::gap::diagnose
