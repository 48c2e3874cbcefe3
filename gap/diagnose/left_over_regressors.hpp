// The regressors of a residual: the simulated quantity itself, its change when it is late, and other measured
// quantities.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnose/left_over.hpp"
#include "gap/diagnose/left_over_series.hpp"

namespace kenaf::gap::diagnose {

// In order of preference if they explain the same.
enum class Regressor {
  simulated,     // the quantity itself: slope -0.48 if 0.52 of it was measured
  delay,         // its change in the last `parameter` seconds, per second: slope -0.2 if it is 0.2 s late
  lag,           // the same for a first-order lag of `parameter` seconds
  ramp,          // the part held back by a rate limit of `parameter`: slope -1
  constant,      // 1
  direction,     // its sign; 0 near 0
  command,       // commanded track speed, mean or of that track
  speed,         // measured, mean of the tracks
  turn,          // measured turn rate
  turn_size,     // its absolute value; for turning quantities that of the simulated quantity
  acceleration,  // forward, measured by the tracks
  load,          // measured current, mean of the tracks' motors
  pitch,
  time,  // since the start of the run
  place_x,
  place_y
};

struct LeftOverCandidate {
  Regressor kind;
  double parameter;       // of delay, lag (s) and ramp (unit of the quantity per second); otherwise 0
  std::string_view name;  // "turn rate"
  std::string_view unit;
};

// One row per span in which the quantity is known, run by run.
struct LeftOverRows {
  QuantityInfo quantity;
  std::vector<LeftOverCandidate> candidates;
  Eigen::MatrixXd x;             // [row][candidate]
  Eigen::VectorXd error, sigma;  // measured minus simulated; its noise, 1 sigma
  Eigen::VectorXd simulated;
  Eigen::VectorXd speed_mps;  // mean absolute track speed; NaN if not measured
  Eigen::VectorXd time_s;
  std::vector<std::size_t> run;  // of each row
  std::size_t runs = 0;
};

// Leaves out regressors that were not measured in nearly all rows, or never change.
LeftOverRows rows_of(std::span<const LeftOverRun> runs, const QuantityInfo& quantity);

bool is_late(Regressor kind);  // delay, lag or ramp

}  // namespace kenaf::gap::diagnose
