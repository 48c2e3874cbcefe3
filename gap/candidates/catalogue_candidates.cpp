#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>

#include "gap/candidates/candidate.hpp"
#include "gap/candidates/search_range.hpp"

namespace kenaf::gap::candidates {
namespace {

using physics::EffectInfo;
using physics::EffectParameter;
using physics::RobotDescription;

constexpr double kLongestLag_s = 2, kLongestDelay_s = 0.6;

// The search range of effects with this prefix and this unit. All others have the catalogue's range.
struct RangeOfEffect {
  std::string_view effect, unit;
  SearchRange (*range)(const RobotDescription&);
};

double length_m(const RobotDescription& robot) {
  return robot.track_length_m();
}

// Limited by the track gauge: a centre of mass farther out would be above one track.
double sideways_m(const RobotDescription& robot) {
  return std::min(0.15 * length_m(robot), 0.25 * robot.track_gauge_m());
}

// With this additional battery resistance, stalled motors have a sixth of the voltage left: R I = 5 (V - R I).
double sagging_ohm(const RobotDescription& robot) {
  const double stalled_a = 2 * robot.drive.amperes_per_newton * robot.drive.max_force_n;
  return stalled_a > 0 ? 5 * robot.battery.open_circuit_v / stalled_a : std::numeric_limits<double>::infinity();
}

constexpr RangeOfEffect kRangesOfEffects[] = {
    // 5 s from rest to full speed
    {"command_slew", "s^2/m",
     [](const RobotDescription& robot) {
       return SearchRange{0, 5 / robot.drive.max_speed_mps};
     }},
    // a tenth of what the tracks can do
    {"command_limit_forward", "s/m",
     [](const RobotDescription& robot) {
       return SearchRange{0, 10 / robot.drive.max_speed_mps};
     }},
    {"command_limit_turn", "s/rad",
     [](const RobotDescription& robot) {
       return SearchRange{0, 5 * robot.track_gauge_m() / robot.drive.max_speed_mps};
     }},
    // half of the robot's weight, on any ground
    {"drive_coulomb", "N",
     [](const RobotDescription& robot) {
       return SearchRange{0, 5 * robot.total_mass_kg()};
     }},
    {"drive_viscous", "N s/m",
     [](const RobotDescription& robot) {
       return SearchRange{0, 10 * robot.total_mass_kg()};
     }},
    {"battery_sag", "ohm",
     [](const RobotDescription& robot) {
       return SearchRange{0, sagging_ohm(robot)};
     }},
    // the torque on an arm scales with mass times length
    {"flipper_compliance", "rad/(N m)",
     [](const RobotDescription& robot) {
       return SearchRange{0, 0.58 / (robot.total_mass_kg() * length_m(robot))};
     }},
    {"com_forward", "m",
     [](const RobotDescription& robot) {
       return SearchRange{-0.15 * length_m(robot), 0.15 * length_m(robot)};
     }},
    {"com_left", "m",
     [](const RobotDescription& robot) {
       return SearchRange{-sideways_m(robot), sideways_m(robot)};
     }},
    {"com_up", "m",
     [](const RobotDescription& robot) {
       return SearchRange{-0.09 * length_m(robot), 0.15 * length_m(robot)};
     }},
    // half of the belt's surface speed at full speed
    {"slip_with_speed", "s/m",
     [](const RobotDescription& robot) {
       return SearchRange{0, 0.5 / robot.drive.max_speed_mps};
     }},
    // loose ground has some hundredths of a metre (Wong 2.4), the belly of a small robot ten times as much
    {"shear_deformation", "m",
     [](const RobotDescription& robot) {
       return SearchRange{0, 0.15 * length_m(robot)};
     }},
    {"obstacle_height", "m",
     [](const RobotDescription& robot) {
       return SearchRange{-0.09 * length_m(robot), 0.09 * length_m(robot)};
     }},
    {"obstacle_position", "m",
     [](const RobotDescription& robot) {
       return SearchRange{-0.18 * length_m(robot), 0.18 * length_m(robot)};
     }},
    {"tracked_point_", "m",
     [](const RobotDescription& robot) {
       return SearchRange{-0.5 * length_m(robot), 0.5 * length_m(robot)};
     }},
};

SearchRange sensible_range(const EffectInfo& effect, const EffectParameter& parameter, const RobotDescription& robot) {
  if (parameter.name == "lag_s") return {0, kLongestLag_s};
  if (parameter.name == "delay_s") return {0, kLongestDelay_s};
  for (const RangeOfEffect& known : kRangesOfEffects)
    if (effect.name.starts_with(known.effect) && parameter.unit == known.unit) return known.range(robot);
  return {parameter.min, parameter.max};
}

bool has_sensor(const RobotDescription& robot, std::initializer_list<physics::SensorType> types) {
  return std::ranges::any_of(robot.sensors, [&](const physics::SensorDescription& sensor) {
    return std::ranges::find(types, sensor.type) != types.end();
  });
}

bool can_show(const RobotDescription& robot, const EffectInfo& effect, bool has_obstacles) {
  using enum physics::SensorType;
  if (effect.name == "command_loss") return false;
  if (effect.name.starts_with("flipper_")) return robot.has_flippers();
  if (effect.name.starts_with("obstacle_")) return has_obstacles;
  if (effect.name.starts_with("posture_")) return has_sensor(robot, {ins});
  if (effect.name.starts_with("gyro_")) return has_sensor(robot, {imu});
  if (effect.name.starts_with("encoder_")) return has_sensor(robot, {encoder, tachometer});
  if (effect.name == "shear_deformation") return !robot.has_wheels();
  if (effect.name == "lug_height") return robot.track.front().lug_height_m > 0;
  return true;
}

Candidate candidate_of(const EffectInfo& effect, const EffectParameter& parameter, const RobotDescription& robot) {
  Candidate candidate;
  candidate.effect = effect.name;
  candidate.parameter = parameter.name;
  candidate.name = effect.parameters.size() > 1 ? fmt::format("{}:{}", effect.name, parameter.name) : candidate.effect;
  candidate.unit = parameter.unit;
  candidate.summary = effect.summary;
  candidate.stage = effect.stage;
  candidate.neutral = parameter.neutral;
  candidate.present = robot.effects.*parameter.value;
  const SearchRange range =
      with(with(within(sensible_range(effect, parameter, robot), {parameter.min, parameter.max}), candidate.neutral),
           candidate.present);
  candidate.min = range.min;
  candidate.max = range.max;
  candidate.keys = {fmt::format("effects.{}.{}", effect.name, parameter.name)};
  candidate.set = [at = parameter.value](RobotDescription& varied, double value) { varied.effects.*at = value; };
  return candidate;
}

}  // namespace

std::vector<Candidate> catalogue_candidates(const RobotDescription& robot, bool has_obstacles) {
  std::vector<Candidate> candidates;
  for (const EffectInfo& effect : physics::effect_catalogue()) {
    if (!can_show(robot, effect, has_obstacles)) continue;
    // each parameter of an effect is a candidate of its own
    for (const EffectParameter& parameter : effect.parameters)
      candidates.push_back(candidate_of(effect, parameter, robot));
  }
  return candidates;
}

}  // namespace kenaf::gap::candidates
