#include "can/candrives/path_log.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <stdexcept>

namespace kenaf::candrives {

PathLog::PathLog(const std::string& file) : name_(file), file_(file) {
  file_ << "t_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad,track_left_m,track_right_m\n" << std::flush;
  if (!file_) throw std::runtime_error("cannot write the path to '" + file + "'");
}

PathLog::~PathLog() {
  flush();
}

void PathLog::write(double t_s, const std::function<physics::RobotTruth()>& truth_now) {
  if (t_s < next_s_ - 1e-9) return;
  next_s_ += kPathPeriod_s;
  const physics::RobotTruth truth = truth_now();
  const Eigen::Vector3d angles_rad = physics::roll_pitch_yaw(truth.X_WB.q);
  const Eigen::Vector3d& p = truth.X_WB.p;
  file_ << fmt::format("{:.3f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f}\n", t_s, p.x(), p.y(), p.z(),
                       angles_rad.x(), angles_rad.y(), angles_rad.z(), truth.track_m[0], truth.track_m[1]);
  if (++lines_ % 100 == 0) flush();  // a reader that follows the file is a second behind at most
}

void PathLog::flush() {
  if (file_.flush() || failure_reported_) return;
  failure_reported_ = true;
  fmt::print(stderr, "kenaf-candrives: can no longer write the path to '{}'\n", name_);
}

}  // namespace kenaf::candrives
