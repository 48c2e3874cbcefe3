// Robots of candidates' tests, and whether two of them are the same.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "gap/candidates/candidate.hpp"
#include "tests/formats/runs/temporary_folder.hpp"

namespace kenaf::test {

inline std::string robot_text(const std::string& name) {
  return read_file(std::string(KENAF_SOURCE_DIR) + "/share/robots/" + name + ".toml");
}

inline physics::RobotDescription robot_of(const std::string& name) {
  return physics::parse_robot(robot_text(name), name + ".toml");
}

// Every number that a description has, but mounts, mission packages and cameras.
inline std::vector<double> all_numbers(const physics::RobotDescription& robot) {
  const auto& body = robot.body;
  const auto& drive = robot.drive;
  std::vector<double> numbers{body.mass_kg,
                              body.friction,
                              drive.sprocket_radius_m,
                              drive.max_speed_mps,
                              drive.max_force_n,
                              drive.time_constant_s,
                              drive.moving_mass_kg,
                              drive.encoder_counts_per_radian,
                              drive.amperes_per_newton,
                              drive.idle_amperes,
                              robot.servo.max_speed_radps,
                              robot.servo.max_torque_nm,
                              robot.servo.amperes_per_nm,
                              robot.servo.resolution_rad,
                              robot.battery.open_circuit_v,
                              robot.battery.internal_resistance_ohm,
                              robot.battery.capacity_s};
  const auto add = [&numbers](const Eigen::Vector3d& vector) {
    numbers.insert(numbers.end(), vector.begin(), vector.end());
  };
  for (const auto& vector : {body.size_m, body.p_BBcm_m, body.inertia_kgm2}) add(vector);
  for (const auto& track : robot.track) {
    for (const double value :
         {track.length_m, track.end_radius_m, track.width_m, track.friction_along, track.friction_across,
          static_cast<double>(track.pieces), track.lug_height_m, track.shear_deformation_m})
      numbers.push_back(value);
    add(track.p_BT_m);
  }
  for (const auto& caster : robot.caster) {
    for (const double value : {caster.radius_m, caster.width_m, caster.friction}) numbers.push_back(value);
    add(caster.p_BC_m);
  }
  for (const auto& flipper : robot.flipper) {
    for (const double value : {flipper.mass_kg, flipper.length_m, flipper.pivot_radius_m, flipper.tip_radius_m,
                               flipper.width_m, flipper.friction_along, flipper.friction_across, flipper.min_angle_rad,
                               flipper.max_angle_rad, flipper.start_angle_rad})
      numbers.push_back(value);
    add(flipper.p_BPivot_m);
  }
  for (const auto& sensor : robot.sensors)
    for (const double value : {sensor.period_s, sensor.delay_s, sensor.noise_m, sensor.noise_rad, sensor.noise_radps,
                               sensor.noise_mps2, sensor.noise_a, sensor.noise_v, sensor.bias_rad, sensor.bias_radps})
      numbers.push_back(value);
  for (const physics::EffectInfo& effect : physics::effect_catalogue())
    for (const physics::EffectParameter& parameter : effect.parameters)
      numbers.push_back(robot.effects.*parameter.value);
  return numbers;
}

inline bool same_bits(const physics::RobotDescription& a, const physics::RobotDescription& b) {
  return std::ranges::equal(
      all_numbers(a), all_numbers(b), {}, [](double x) { return std::bit_cast<std::uint64_t>(x); },
      [](double x) { return std::bit_cast<std::uint64_t>(x); });
}

inline std::vector<gap::candidates::Candidate> all_candidates(const physics::RobotDescription& robot) {
  std::vector<gap::candidates::Candidate> candidates = gap::candidates::catalogue_candidates(robot, true);
  for (gap::candidates::Candidate& candidate : gap::candidates::description_candidates(robot))
    candidates.push_back(std::move(candidate));
  return candidates;
}

// Null: there is none of that name.
inline const gap::candidates::Candidate* find_candidate(const std::vector<gap::candidates::Candidate>& candidates,
                                                        std::string_view name) {
  const auto found = std::ranges::find(candidates, name, &gap::candidates::Candidate::name);
  return found == candidates.end() ? nullptr : &*found;
}

inline physics::RobotDescription with(physics::RobotDescription robot, const gap::candidates::Candidate& candidate,
                                      double value) {
  candidate.set(robot, value);
  return robot;
}

}  // namespace kenaf::test
