// What a left-over is regressed on: the simulated quantity itself, what comes of it when it is late, and what else was
// measured.
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

// In the order in which they are preferred where they explain the same.
enum class Regressor {
  simulated,  // the quantity itself: slope -0.48 where 0.52 of it was measured
  delay,      // what it changed by in the last `parameter` seconds, for each second: slope -0.2 where it is 0.2 s late
  lag,        // the same of a first-order lag of `parameter` seconds
  ramp,       // what a limit of `parameter` on its change holds back: slope -1
  constant,   // 1
  direction,  // its sign; 0 about 0
  command,    // commanded track speed, mean or of that track
  speed,      // measured, mean of the tracks
  turn,       // measured turn rate
  turn_size,  // its absolute value
  acceleration,  // forward, measured by the tracks
  load,          // measured current, mean of the tracks' motors
  pitch,
  time,  // since the start of the run
  place_x,
  place_y
};

struct LeftOverCandidate {
  Regressor kind;
  double parameter;       // of delay, lag (s) and ramp (unit of the quantity for each second); otherwise 0
  std::string_view name;  // "turn rate"
  std::string_view unit;
};

// One row for each span in which the quantity is known, run after run.
struct LeftOverRows {
  QuantityInfo quantity;
  std::vector<LeftOverCandidate> candidates;
  Eigen::MatrixXd x;             // [row][candidate]
  Eigen::VectorXd error, sigma;  // measured minus simulated; its noise
  Eigen::VectorXd simulated;
  Eigen::VectorXd speed_mps;  // how fast the tracks run, the mean of their sizes; NaN where not measured
  Eigen::VectorXd time_s;
  std::vector<std::size_t> run;  // of each row
  std::size_t runs = 0;
};

// Left out: what was not measured in nearly all rows, or never changes.
LeftOverRows rows_of(std::span<const LeftOverRun> runs, const QuantityInfo& quantity);

bool is_late(Regressor kind);  // delay, lag or ramp

}  // namespace kenaf::gap::diagnose
