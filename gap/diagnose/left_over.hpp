// Describes a model's residual in words: which measured quantities it depends on, and which numbers and effects that
// suggests.
//
// A residual usually has a pattern: turns that are always too small, a delayed speed, a current with an offset.
// Measured minus simulated is regressed on measured and simulated quantities, with a few terms per channel, each of
// which has to hold on runs that its fit has not seen.
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

// The residual of one stage in one run. The pointers must outlive the call.
struct LeftOverRun {
  const Observation* observation;
  const FeatureMap* features;           // of channels that are both measured and simulated
  Eigen::VectorXd measured, simulated;  // of features->bins(), in the channels' units; by the best model
  Eigen::VectorXd sigma;                // noise of each bin, 1 sigma, in the channels' units
  std::size_t group;                    // group of repeats; its runs are held out together
};

// One term of the fit of one channel.
struct Dependence {
  std::string channel;      // "yaw rate"; poses are described by their rates: forward, sideways and about the vertical
  std::string on;           // "simulated yaw rate", "time since the start"; "run" if runs differ from each other
  double share;             // of the channel's squared residual beyond noise, on held-out runs, 0 to 1
  double slope, intercept;  // of the channel's residual over `on`: the line through `points`
  std::string words;        // one sentence, without a full stop
  std::vector<std::string> look_at;  // keys of the description, and effects: "track.separation_m", "friction_across"
  std::vector<std::array<double, 2>> points{};  // (on, residual without the channel's other terms), at most 400
  std::string on_unit{}, unit{};                // units of the points' two numbers; may be empty
};

// Minimum share of a reported term in the squared residual beyond noise on held-out runs (chosen).
inline constexpr double kLeastReported = 0.1;

// Returns the terms of all channels, largest share of the channel first: at most three per channel, and one more for
// differences between runs. Empty if the residual is within noise or depends on nothing that was measured. `of_drives`:
// of track speeds, currents and voltage, as from command to drive; else of pose and gyro, as from drive to body.
//
// `runs` may be empty. Throws std::invalid_argument if a vector's size differs from features->bins().
//
// Deterministic.
std::vector<Dependence> describe_left_over(std::span<const LeftOverRun> runs, bool of_drives);

}  // namespace kenaf::gap::diagnose
