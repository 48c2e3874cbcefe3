#include "gap/recordings/pose_of_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gap/recordings/recording_error.hpp"

namespace kenaf::gap::recordings {
namespace {

constexpr double kNormTolerance_1 = 0.01;  // as of a motion capture's file: quaternions written with few digits

Eigen::Vector3d axis_named(char name) {
  return name == 'x' ? Eigen::Vector3d::UnitX() : name == 'y' ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
}

// Numbers of several sources at the times that all of them have.
struct Joined {
  std::vector<double> t_s;
  std::vector<std::vector<double>> numbers;  // by time, in the order of the sources
};

Joined joined(const std::vector<const Samples*>& sources) {
  Joined all;
  std::vector<std::size_t> at(sources.size(), 0);
  for (const double t : sources.front()->t_s) {
    std::vector<double> numbers;
    for (std::size_t i = 0; i < sources.size(); ++i) {
      const Samples& samples = *sources[i];
      while (at[i] < samples.t_s.size() && samples.t_s[at[i]] < t) ++at[i];
      if (at[i] == samples.t_s.size() || samples.t_s[at[i]] != t) break;
      numbers.push_back(samples.value[at[i]]);
    }
    if (numbers.size() < sources.size()) continue;
    all.t_s.push_back(t);
    all.numbers.push_back(std::move(numbers));
  }
  return all;
}

}  // namespace

Eigen::Quaterniond rotation_of(const std::string& order, std::span<const double> numbers) {
  if (order == "quaternion") return Eigen::Quaterniond(numbers[3], numbers[0], numbers[1], numbers[2]).normalized();
  if (order == "vector") {
    const Eigen::Vector3d vector(numbers[0], numbers[1], numbers[2]);
    const double angle = vector.norm();
    return angle > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, vector / angle)) : Eigen::Quaterniond::Identity();
  }
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  for (std::size_t i = 0; i < order.size(); ++i) q = q * Eigen::AngleAxisd(numbers[i], axis_named(order[i]));
  return q;
}

PoseOfSamples pose_of_samples(const PoseMapping& mapping, const Collected& collected) {
  // Only times at which all numbers of a pose were recorded.
  std::vector<const Samples*> sources;
  for (const auto* names : {&mapping.position, &mapping.rotation})
    for (const std::string& from : *names) sources.push_back(&collected.samples.at({from, mapping.timing.time}));
  const Joined all = joined(sources);
  const std::size_t places = mapping.position.size();
  const bool is_quaternion = mapping.order == "quaternion";

  // Each becomes a pose in SI units; a quaternion that is none is left out and counted.
  PoseOfSamples found{{{}, places == 3, mapping.order.find_first_not_of('z') != std::string::npos}, {}};
  std::size_t not_of_norm_1 = 0;
  for (std::size_t i = 0; i < all.t_s.size(); ++i) {
    const std::span<const double> position(all.numbers[i].data(), places);
    std::vector<double> rotation(all.numbers[i].begin() + static_cast<std::ptrdiff_t>(places), all.numbers[i].end());
    const double norm = Eigen::Map<const Eigen::VectorXd>(rotation.data(), std::ssize(rotation)).norm();
    if (is_quaternion && std::abs(norm - 1) > kNormTolerance_1) {
      ++not_of_norm_1;
      continue;
    }
    if (!is_quaternion)
      for (double& angle : rotation) angle *= mapping.angle_factor;
    const double z = places == 3 ? position[2] : 0;
    found.capture.poses.push_back({all.t_s[i], mapping.length_factor * Eigen::Vector3d(position[0], position[1], z),
                                   rotation_of(mapping.order, rotation)});
  }
  if (not_of_norm_1 > 0)
    found.remarks.push_back(fmt::format("{} poses are left out: their quaternion's norm is not 1", not_of_norm_1));

  // Turned so that z points up, by the mapping or as it is seen.
  if (found.capture.poses.size() < 2) throw RecordingError("the [pose]: fewer than two poses have all their numbers");
  try {
    found.capture = logs::with_z_up(std::move(found.capture), mapping.up.value_or(logs::Up::z), "the [pose]");
  } catch (const runs::RunFileError& error) {
    throw RecordingError(error.what());
  }
  return found;
}

}  // namespace kenaf::gap::recordings
