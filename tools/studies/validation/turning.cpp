#include "tools/studies/validation/turning.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tools/studies/validation/steady_motion.hpp"

namespace kenaf::validation {
namespace {

using physics::RobotDescription;

constexpr double kSpeed_mps = 0.2;

double effective_width_m(const RobotDescription& robot) {
  return 2 * kSpeed_mps / steady_motion(robot, -kSpeed_mps, kSpeed_mps).turn_radps;
}

// The moment of friction about the middle, per coefficient and load: at (x, y) a surface that runs at u slips by
// (u - w y, -w x). Both sides are alike; a track is cut into `cells` along and across, a wheel across.
double friction_moment(const RobotDescription& robot, double turn_radps) {
  constexpr int kCells = 60;
  double sum = 0;
  for (const physics::TrackDescription& track : robot.track) {
    const int along = track.straight_m() > 0 ? kCells : 1;
    for (int i = 0; i < along; ++i) {
      for (int k = 0; k < kCells; ++k) {
        const double x = track.p_BT_m.x() + track.straight_m() * ((i + 0.5) / along - 0.5);
        const double y = track.p_BT_m.y() + track.width_m * ((k + 0.5) / kCells - 0.5);
        const double slip_x = kSpeed_mps - turn_radps * y, slip_y = turn_radps * x;
        sum += (y * slip_x - x * slip_y) / (along * std::hypot(slip_x, slip_y));
      }
    }
  }
  return sum;
}

double closed_form_radps(const RobotDescription& robot) {
  double low = 0, high = 4 * kSpeed_mps / robot.track_gauge_m();
  for (int i = 0; i < 60; ++i) (friction_moment(robot, (low + high) / 2) > 0 ? low : high) = (low + high) / 2;
  return low;
}

}  // namespace

std::vector<ComparisonRow> turns_of_real_robots() {
  struct Real {
    const char *robot, *source;
    double width_m;
  };
  constexpr Real kReal[] = {
      {"maxxii", "0.855 (sd 0.041) of a slipless turn at 0.606 m, 32 turns (arXiv 2409.18641)", 0.606 / 0.855},
      {"marmotte", "0.956 of a slipless turn at 0.593 m (norlab-ulaval/DRIVE)", 0.592723 / 0.956},
      {"husky", "0.52 of a slipless turn at 0.555 m (the same project)", 0.555 / 0.52},
      {"warthog", "0.58 of a slipless turn at 1.08 m, asphalt (the same project)", 1.08 / 0.58},
      {"jackal", "`wheel_separation_multiplier` 1.5 of 0.376 m (jackal_control)", 0.563},
      {"p3at", "2 / `DiffConvFactor` (AriaCoda, p3at-sh.p)", 0.588},
  };
  std::vector<ComparisonRow> rows;
  for (const Real& real : kReal)
    rows.push_back({fmt::format("`{}`, effective width", real.robot), real.source, real.width_m,
                    effective_width_m(physics::load_robot(real.robot)), "m"});
  return rows;
}

std::vector<ComparisonRow> turns_by_closed_form() {
  std::vector<ComparisonRow> rows;
  for (const char* name : {"kenaf", "marmotte", "husky", "p3at"}) {
    RobotDescription robot = physics::load_robot(name);
    robot.flipper.clear();
    robot.body.p_BBcm_m.x() = robot.body.p_BBcm_m.y() = 0;
    robot.drive.max_force_n = 1e4;
    for (physics::TrackDescription& track : robot.track) {
      track.friction_along = track.friction_across = 0.8;
      if (track.straight_m() > 0) track.pieces = 16;  // nearer to uniform pressure than the description's
    }
    rows.push_back({fmt::format("`{}`, turn rate on the spot at 0.2 m/s", name),
                    robot.has_wheels() ? "moment of friction, a quarter of the load on each wheel"
                                       : "moment of friction, uniform pressure",
                    closed_form_radps(robot), steady_motion(robot, -kSpeed_mps, kSpeed_mps).turn_radps, "rad/s"});
  }
  return rows;
}

}  // namespace kenaf::validation
