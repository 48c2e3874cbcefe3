// Estimates the offset between two clocks that saw the same motion, from quantities that both measured and that do not
// depend on the frame, such as travel and turned angle.
//
// Coarse search: mean rates of each quantity over a window, on a common grid. For every offset of whole grid steps the
// robot's rate is fitted by the other one's times a gain, bounded to values that robots have; the offset with the
// highest likelihood wins. Refinement: least squares for offset and gain, for each quantity by itself; the offsets are
// averaged with inverse-variance weights. The standard error is that of least squares with correlated residuals:
// Var(offset) = Var(sum(slope residual)) / sum(slope^2)^2, with slope = d residual / d offset, and the numerator once
// from the autocovariance of the residuals and once from that of the products (Newey and West 1987), whichever is
// larger. Where quantities disagree beyond their errors, it is scaled by the Birge ratio.
//
// Limits: a sensor that reports late looks like a clock that is behind. If the clocks drift apart, the result is the
// offset in the middle of the motion; clock_drift.hpp estimates the drift.
//
// Thread safety: pure functions.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "gap/logs/course.hpp"

namespace kenaf::gap::logs {

// The offset cannot be determined; what() says why, in words for the user.
class NoOffset : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// One quantity as both clocks saw it.
struct CourseSeenTwice {
  std::string name;  // for the report: "turn about z (gyro_z_radps)"
  Course robot, capture;
  double least_gain, most_gain;  // bounds of robot's rate / the other's; both positive
  double enough;                 // a smaller range, in the quantity's own unit, counts as no motion
  bool slips;                    // measured at the tracks: belts lead and slip, so others are preferred
};

struct QuantityOffset {
  std::string name;
  double offset_s, standard_error_s;
  double gain;         // robot's rate / the other's
  double correlation;  // of the two rates at the offset, without subtracting means
  bool used;           // part of the result; otherwise for comparison only
};

struct ClockOffset {
  double offset_s = 0;  // robot's time = the other clock's time + offset
  double standard_error_s = 0;
  double overlap_s = 0;                    // time during which both clocks saw the robot
  std::vector<QuantityOffset> quantities;  // those that determine an offset
  bool from_tracks = false;                // only tracks were used: valid as far as the body follows them at once
};

// Throws NoOffset if nothing was seen twice, nothing moves, the logs do not overlap or do not agree, more than one
// offset fits, or the standard error exceeds 0.25 s. If a gain outside its bounds would fit, the message says which
// unit or sign looks wrong.
ClockOffset estimate_clock_offset(const std::vector<CourseSeenTwice>& courses);

}  // namespace kenaf::gap::logs
