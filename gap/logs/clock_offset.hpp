// How far two clocks are apart that saw the same motion: from quantities that both measured and that do not depend on
// the frame, such as travel and turned angle.
//
// Coarsely: the mean rates of each quantity over a window, on a common grid; for every offset by whole grid steps the
// robot's rate is fitted by the other one's times a gain (bounded: what no robot has is no match), and the offset with
// the highest likelihood wins. Then by least squares of offset and gain, each quantity on its own, and averaged by
// their inverse variances. The standard error is that of least squares with correlated residuals: (j'j)^-2 times
// the variance of j'r, once with the autocovariance of all residuals r and once with that of the products j r (Newey
// and West 1987), whichever is larger; where quantities disagree beyond their errors, it is scaled by how much (Birge).
//
// What it cannot know: a sensor that reports late looks like a clock that is behind. Clocks that run at different
// speeds are not modelled.
//
// Thread safety: pure functions.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "gap/logs/course.hpp"

namespace kenaf::gap::logs {

// Why the offset cannot be known, in words for the user.
class NoOffset : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// One quantity as both clocks saw it.
struct CourseSeenTwice {
  std::string name;  // for the report: "turn about z (gyro_z_radps)"
  Course robot, capture;
  double least_gain, most_gain;  // robot's rate over the other's; both positive
  double enough;                 // less than this in all, of the quantity's own unit, is no motion
  bool slips;                    // measured at the tracks: belts lead and slip, so others are preferred
};

struct QuantityOffset {
  std::string name;
  double offset_s, standard_error_s;
  double gain;         // robot's rate over the other's
  double correlation;  // of the two rates, about zero, at the offset
  bool used;           // in the result; else only for comparison
};

struct ClockOffset {
  double offset_s = 0;  // robot's time = the other clock's time + offset
  double standard_error_s = 0;
  double overlap_s = 0;                    // during which both clocks saw the robot
  std::vector<QuantityOffset> quantities;  // those that tell the offset
  bool from_tracks = false;                // only tracks told it: it holds as far as the body follows them at once
};

// Throws NoOffset: nothing seen twice, no motion, no overlap, no agreement, more than one offset that fits, or an error
// above 0.25 s. Where a gain outside of its bounds would fit, the words say which unit or sign looks wrong.
ClockOffset estimate_clock_offset(const std::vector<CourseSeenTwice>& courses);

}  // namespace kenaf::gap::logs
