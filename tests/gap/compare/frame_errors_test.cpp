// Errors per frame and what they sum up to.
#include "gap/compare/frame_errors.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace kenaf::gap;
using namespace kenaf::gap::compare;

namespace {

constexpr double kSpeed_mps = 0.2, kPeriod_s = 0.01;

// A robot that stands for `wait` frames, drives for 100, and stands for `rest`; its pitch follows its place.
std::vector<PoseFrame> drive(int wait, int rest, double z_m = 0.1) {
  std::vector<PoseFrame> frames;
  for (int i = 0; i <= wait + 100 + rest; ++i) {
    const double x = kSpeed_mps * kPeriod_s * std::min(100, std::max(0, i - wait));
    frames.push_back({i * kPeriod_s, x, z_m, 0, 0, -x, 0});
  }
  return frames;
}

RunErrors compared(const std::vector<PoseFrame>& real, const std::vector<PoseFrame>& sim) {
  return run_errors(Plane::vertical, real, sim,
                    match_paths(path_in(Plane::vertical, real), path_in(Plane::vertical, sim)).pairs);
}

}  // namespace

TEST_CASE("One frame: the norm of (x, z), differences simulated less real, angles wrapped") {
  const PoseFrame real{1.0, 0, 0, 5, 0.1, 0, 3.1}, sim{1.5, 0.003, 0.004, 4, -0.1, 0.2, -3.1};
  const FrameError error = frame_error(Plane::vertical, real, sim);
  CHECK(error.position_m == Approx(0.005));
  CHECK(error.y_m == -1);
  CHECK(error.roll_rad == Approx(-0.2));
  CHECK(error.pitch_rad == Approx(0.2));
  CHECK(error.yaw_rad == Approx(2 * (3.14159265358979 - 3.1)));
  CHECK(error.time_s == 0.5);
  // in the ground plane: 3 mm along x, 1 m along y
  CHECK(frame_error(Plane::ground, real, sim).position_m == Approx(std::hypot(0.003, 1)));
}

TEST_CASE("Mean, RMS and maximum of sizes, what was not measured is not counted") {
  Summary summary;
  CHECK(std::isnan(summary.mean()));
  CHECK(std::isnan(summary.max()));
  summary.add(-3);
  summary.add(1, 0.5);
  summary.add(1, 0.5);
  summary.add(std::nan(""));
  CHECK(summary.weight() == 2);
  CHECK(summary.mean() == Approx(2));
  CHECK(summary.rms() == Approx(std::sqrt(5.0)));
  CHECK(summary.max() == 3);
}

TEST_CASE("Matching hides a delay, the same time shows it") {
  // 0.1 s late at 0.2 m/s: 20 mm behind while both drive.
  const auto real = drive(20, 20), sim = drive(30, 10);
  const RunErrors errors = compared(real, sim);
  CHECK(errors.matched_summary.position_m.max() == 0);
  CHECK(errors.matched_summary.pitch_rad.max() == 0);
  CHECK(errors.matched_summary.position_m.weight() == Approx(static_cast<double>(real.size())));
  CHECK(errors.same_time[70].position_m == Approx(0.02));
  CHECK(errors.same_time_summary.position_m.max() == Approx(0.02));
  CHECK(errors.matched[70].time_s == Approx(0.1));
  // One after the other, 10 frames that grow by 2 mm, 90 at 20 mm and 9 that fall: (90 + 90) mm + 91 * 20 mm over 141.
  CHECK(errors.same_time_summary.position_m.mean() == Approx((2 * 0.09 + 91 * 0.02) / 141));
}

TEST_CASE("A run that is higher by 12 mm is wrong by 12 mm in every frame, and at its end") {
  const RunErrors errors = compared(drive(5, 5, 0.1), drive(5, 5, 0.112));
  CHECK(errors.matched_summary.position_m.mean() == Approx(0.012));
  CHECK(errors.matched_summary.position_m.rms() == Approx(0.012));
  CHECK(errors.same_time_summary.position_m.mean() == Approx(0.012));
  CHECK(errors.at_end.position_m == Approx(0.012));
}

TEST_CASE("Every real frame counts once, however many simulated frames it is matched with") {
  // Four simulated frames pass while the real robot stands at its first frame.
  const std::vector<FramePair> pairs{{0, 0}, {0, 1}, {0, 2}, {0, 3}, {1, 4}};
  CHECK(pair_weights(pairs) == std::vector<double>{0.25, 0.25, 0.25, 0.25, 1});
  std::vector<PoseFrame> real = drive(0, 0), sim = drive(0, 0);
  real.resize(2);
  sim.resize(5);
  for (PoseFrame& frame : sim) frame.z_m += 1;
  sim[4] = real[1];
  const RunErrors errors = run_errors(Plane::vertical, real, sim, pairs);
  CHECK(errors.matched_summary.position_m.weight() == Approx(2));
  CHECK(errors.matched[0].position_m == Approx(1).epsilon(1e-4));
  CHECK(errors.matched_summary.position_m.mean() == Approx(0.5).epsilon(1e-4));
}

TEST_CASE("A simulated robot that drives too far shows in the largest error and at the end") {
  auto sim = drive(0, 0);
  for (int i = 1; i <= 50; ++i) sim.push_back({sim.back().t_s + kPeriod_s, 0.2 + 0.002 * i, 0.1, 0, 0, 0, 0});
  const RunErrors errors = compared(drive(0, 0), sim);
  CHECK(errors.matched_summary.position_m.max() == Approx(0.1));
  CHECK(errors.at_end.position_m == Approx(0.1));
}

TEST_CASE("Outside of the simulated run's time nothing is compared at the same time") {
  const auto real = drive(0, 0);
  auto sim = real;
  sim.resize(51);
  const RunErrors errors = compared(real, sim);
  CHECK(errors.same_time_summary.position_m.weight() == 51);
  CHECK(std::isnan(errors.same_time.back().position_m));
}
