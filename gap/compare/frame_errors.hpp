// The errors of a simulated run against a real one: per frame of the real run, and summarized.
//
// There are two comparisons. *Matched*: with the simulated frames of the DP matching; it compares paths and hides
// delays. *Same time*: with the simulated pose at the real frame's own time; it shows delays.
//
// Errors are simulated less real; angles are wrapped to [-pi, pi]. NaN: one of the two was not measured.
//
// Thread safety: values and pure functions.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "gap/compare/dp_matching.hpp"
#include "gap/compare/pose_frames.hpp"

namespace kenaf::gap::compare {

struct FrameError {
  double position_m;  // the norm of the difference in the plane of the comparison, never negative
  double y_m;
  double roll_rad, pitch_rad, yaw_rad;
  double time_s;  // how much later the simulated frame is; NaN if compared at the same time
};

FrameError frame_error(Plane plane, const PoseFrame& real, const PoseFrame& sim);

// Summary of the absolute values of an error. All figures are NaN if there were none.
class Summary {
 public:
  // Ignores an error that is NaN.
  void add(double error, double weight = 1);
  void add(const Summary& other);

  double weight() const { return weight_; }  // number of frames
  double mean() const;
  double rms() const;
  double max() const;

 private:
  double weight_ = 0, sum_ = 0, sum_of_squares_ = 0, max_ = 0;
};

struct ErrorSummary {
  Summary position_m, y_m, roll_rad, pitch_rad, yaw_rad, time_s;
  void add(const FrameError& error, double weight = 1);
  void add(const ErrorSummary& other);
};

struct RunErrors {
  // A real frame in several pairs has the mean of their absolute errors.
  std::vector<FrameError> matched;    // one for each real frame; absolute values, but time_s with its sign
  std::vector<FrameError> same_time;  // one for each real frame; all NaN outside the simulated run's time
  // Every real frame counts once: the pairs that contain it share its weight.
  ErrorSummary matched_summary, same_time_summary;
  FrameError at_end;  // between the two last frames
};

RunErrors run_errors(Plane plane, const std::vector<PoseFrame>& real, const std::vector<PoseFrame>& sim,
                     const std::vector<FramePair>& pairs);

// Returns the weight of each pair: one over the number of pairs that contain its real frame.
std::vector<double> pair_weights(const std::vector<FramePair>& pairs);

}  // namespace kenaf::gap::compare
