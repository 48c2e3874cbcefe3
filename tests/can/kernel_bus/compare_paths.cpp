// Whether two recorded runs drove the same path: compare_paths A.csv B.csv LIMIT_MM LIMIT_DEG
//
// For each pose of one there must be a pose of the other within both limits, and the other way round; the times at
// which they were there do not count. Prints the farthest of all. Poses of B are taken between its samples too
// (straight, evenly). Exit status: 0 they did; 1 they did not; 2 wrong arguments, or no such runs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "formats/runs/run_file.hpp"
#include "formats/settings/numbers.hpp"

namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kBetweenSamples = 4;

struct PlanarPose {
  double x_m, y_m, yaw_rad;
};

double turn(double from_rad, double to_rad) {
  return std::remainder(to_rad - from_rad, 2 * std::numbers::pi);
}

// Poses relative to the first one, so that it does not matter where in its world each began.
std::vector<PlanarPose> path_of(const char* file) {
  const kenaf::runs::Run run = kenaf::runs::read_run(file);
  const auto x = run.column("x_m"), y = run.column("y_m"), yaw = run.column("yaw_rad");
  if (x.empty() || y.empty() || yaw.empty())
    throw kenaf::runs::RunFileError(fmt::format("{}: no x_m, y_m, yaw_rad", file));
  std::vector<PlanarPose> path;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isnan(x[i])) path.push_back({x[i], y[i], yaw[i]});
  }
  if (path.size() < 2) throw kenaf::runs::RunFileError(fmt::format("{}: fewer than two poses", file));
  const PlanarPose first = path.front();
  const double c = std::cos(first.yaw_rad), s = std::sin(first.yaw_rad);
  for (PlanarPose& pose : path) {
    const double dx = pose.x_m - first.x_m, dy = pose.y_m - first.y_m;
    pose = {c * dx + s * dy, c * dy - s * dx, turn(first.yaw_rad, pose.yaw_rad)};
  }
  return path;
}

std::vector<PlanarPose> between_samples(const std::vector<PlanarPose>& path) {
  std::vector<PlanarPose> fine;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const PlanarPose &a = path[i], &b = path[i + 1];
    for (int k = 0; k < kBetweenSamples; ++k) {
      const double share = static_cast<double>(k) / kBetweenSamples;
      fine.push_back({std::lerp(a.x_m, b.x_m, share), std::lerp(a.y_m, b.y_m, share),
                      a.yaw_rad + share * turn(a.yaw_rad, b.yaw_rad)});
    }
  }
  fine.push_back(path.back());
  return fine;
}

// Of the pose that is farthest from the path: in shares of the limits, and the two numbers themselves.
struct Farthest {
  double share = 0, distance_m = 0, angle_rad = 0;
};
Farthest farthest(const std::vector<PlanarPose>& from, const std::vector<PlanarPose>& path, double limit_m,
                  double limit_rad) {
  Farthest worst;
  for (const PlanarPose& pose : from) {
    Farthest nearest{.share = std::numeric_limits<double>::infinity()};
    for (const PlanarPose& other : path) {
      const double distance_m = std::hypot(other.x_m - pose.x_m, other.y_m - pose.y_m);
      const double angle_rad = std::abs(turn(other.yaw_rad, pose.yaw_rad));
      const double share = std::max(distance_m / limit_m, angle_rad / limit_rad);
      if (share < nearest.share) nearest = {share, distance_m, angle_rad};
    }
    if (nearest.share > worst.share) worst = nearest;
  }
  return worst;
}

double limit_from(const char* name, const char* text) {
  const auto limit = kenaf::settings::number_from(text);
  if (!limit || *limit <= 0) throw std::invalid_argument(fmt::format("{} '{}': must be a number above 0", name, text));
  return *limit;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 5) {
    fmt::print(stderr, "usage: compare_paths A.csv B.csv LIMIT_MM LIMIT_DEG\n");
    return 2;
  }
  const double limit_m = 1e-3 * limit_from("LIMIT_MM", argv[3]), limit_rad = kDegree * limit_from("LIMIT_DEG", argv[4]);
  const std::vector<PlanarPose> a = path_of(argv[1]), b = path_of(argv[2]);
  const Farthest there = farthest(a, between_samples(b), limit_m, limit_rad);
  const Farthest back = farthest(b, between_samples(a), limit_m, limit_rad);
  const Farthest& worst = there.share > back.share ? there : back;
  fmt::print("{} and {} poses: no farther apart than {:.2f} mm and {:.3f} degrees\n", a.size(), b.size(),
             1e3 * worst.distance_m, worst.angle_rad / kDegree);
  return worst.share <= 1 ? 0 : 1;
} catch (const std::exception& error) {
  fmt::print(stderr, "compare_paths: {}\n", error.what());
  return 2;
}
