#include "gap/candidates/candidate.hpp"
namespace kenaf::gap {
std::vector<Candidate> catalogue_candidates(const physics::RobotDescription& robot, bool has_obstacles) {
  std::vector<Candidate> out;
  for (const physics::EffectInfo& effect : physics::effect_catalogue()) {
    if (effect.name == "command_loss") continue;
    if (effect.name.starts_with("flipper_") && !robot.has_flippers()) continue;
    if (effect.name.starts_with("obstacle_") && !has_obstacles) continue;
    for (const physics::EffectParameter& p : effect.parameters)
      out.push_back({std::string(effect.name), std::string(effect.name), std::string(p.name), std::string(p.unit), std::string(effect.summary), effect.stage, p.neutral, robot.effects.*p.value, p.min, p.max, false, "",
        [value = p.value](physics::RobotDescription& r, double v) { r.effects.*value = v; }});
  }
  return out;
}
}  // namespace kenaf::gap
