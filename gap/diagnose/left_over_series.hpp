// The quantities in which residuals are described: rates of the body instead of its pose, both tracks as mean and
// difference.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string_view>

#include "gap/diagnose/left_over.hpp"

namespace kenaf::gap::diagnose {

enum class Quantity {
  track_mean,
  track_difference,  // right minus left
  left_track,
  right_track,
  current,  // mean of the tracks' motors
  battery,
  forward,  // in the body frame, from the pose
  sideways,
  yaw_rate,  // from the pose
  gyro,
  pitch,
  roll,
  height
};

struct QuantityInfo {
  Quantity quantity;
  std::string_view name, unit;
  bool drive;  // between command and drive
};
std::span<const QuantityInfo> left_over_quantities();

// One quantity of one run: a value for each span from the start of the run, NaN where it was not measured.
struct QuantitySeries {
  Eigen::VectorXd measured, simulated, sigma;
};
// Empty if it was measured nowhere in the run.
QuantitySeries series_of(const LeftOverRun& run, Quantity quantity);

// The mean of a measured column over each span; empty without such a column.
Eigen::VectorXd column_by_span(const LeftOverRun& run, std::string_view column);

// The number of spans of the run.
Eigen::Index span_count(const LeftOverRun& run);

// Replaces NaN: linear between known values, constant beyond them; 0 if none is known.
Eigen::VectorXd filled(const Eigen::VectorXd& values);

// Rate of change per second, over half a second or slightly more; NaN at the ends and next to gaps.
Eigen::VectorXd rate_of(const Eigen::VectorXd& values, double span_s);

}  // namespace kenaf::gap::diagnose
