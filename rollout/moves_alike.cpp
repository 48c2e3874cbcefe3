#include "rollout/moves_alike.hpp"

#include "physics/effects.hpp"
#include "rollout/first_report.hpp"

namespace kenaf::rollout {
namespace {

using physics::SensorType;

bool is_of_drives(const physics::SensorDescription& sensor) {
  return sensor.type == SensorType::encoder || sensor.type == SensorType::tachometer ||
         sensor.type == SensorType::drives;
}

}  // namespace

physics::RobotDescription as_it_moves(physics::RobotDescription robot, const physics::WorldDescription& world,
                                      const Manoeuvre& manoeuvre) {
  const double late = starts_elsewhere(robot.effects, world, manoeuvre) ? late_s(robot.effects) : 0;
  const bool by_reports = manoeuvre.measured || (manoeuvre.start && manoeuvre.start->motion);
  std::erase_if(robot.sensors,
                [&](const physics::SensorDescription& sensor) { return !by_reports || !is_of_drives(sensor); });
  for (const physics::EffectInfo& effect : physics::effect_catalogue()) {
    if (effect.stage != physics::Stage::sensor) continue;
    if (by_reports && effect.name.starts_with("encoder_")) continue;
    for (const physics::EffectParameter& parameter : effect.parameters)
      robot.effects.*parameter.value = parameter.neutral;
  }
  robot.effects.clock_offset_s = late;
  if (world.boxes.empty() && world.meshes.empty())  // all that with_terrain_effects() moves or raises
    robot.effects.obstacle_height_m = robot.effects.obstacle_position_m = 0;
  return robot;
}

}  // namespace kenaf::rollout
