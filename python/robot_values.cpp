#include "python/robot_values.hpp"

#include <fmt/format.h>

#include <optional>
#include <set>
#include <stdexcept>
#include <vector>

#include "gap/candidates/robot_numbers.hpp"
#include "physics/effects.hpp"

namespace kenaf::python {
namespace {

using gap::candidates::RobotNumber;

// A number by name: the keys in the robot's file that it changes, and how.
struct Named {
  std::vector<std::string> keys;
  std::function<void(physics::RobotDescription&, double)> set;
};

Named number_of_description(const RobotNumber& number) {
  return {number.written_as, [number](physics::RobotDescription& robot, double value) {
            const auto& [min, max, open_min] = number.range;
            if (!(value >= min && value <= max) || (open_min && value == min))
              throw std::invalid_argument(
                  fmt::format("{}: {} is out of range; it goes from {} to {}", number.key, value, min, max));
            number.set(robot, value);
          }};
}

// `name`: "NAME:PARAMETER", or "NAME" of an effect with one parameter.
Named parameter_of_effect(const std::string& name, const physics::RobotDescription& robot) {
  const std::string effect_name = name.substr(0, name.find(':'));
  const physics::EffectInfo* effect = physics::find_effect(effect_name);
  if (!effect)
    throw std::invalid_argument(fmt::format(
        "{}: is neither a number of {} nor an effect; kenaf.parameters() lists what there is", name, robot.name));
  if (name == effect_name && effect->parameters.size() > 1)
    throw std::invalid_argument(fmt::format("{}: has several parameters; write {}:{}, for example", name, name,
                                            effect->parameters.front().name));
  const std::string parameter =
      name == effect_name ? std::string(effect->parameters.front().name) : name.substr(effect_name.size() + 1);
  return {{fmt::format("effects.{}.{}", effect_name, parameter)},
          [assigned = fmt::format("{}:{}=", effect_name, parameter)](physics::RobotDescription& changed, double value) {
            physics::set_effect(changed.effects, assigned + fmt::format("{}", value));
          }};
}

Named find_named(const std::string& name, const physics::RobotDescription& robot) {
  if (const auto number = gap::candidates::find_robot_number(robot, name)) return number_of_description(*number);
  return parameter_of_effect(name, robot);
}

}  // namespace

physics::RobotDescription robot_with(const physics::RobotDescription& robot, const Values& values) {
  physics::RobotDescription changed = robot;
  std::set<std::string> keys;
  for (const auto& [name, value] : values) {
    const Named named = find_named(name, robot);
    for (const std::string& key : named.keys)
      if (!keys.insert(key).second)
        throw std::invalid_argument(fmt::format("{}: another name sets the same number, {}", name, key));
    named.set(changed, value);
  }
  if (const std::string why = gap::candidates::why_impossible(changed); !why.empty()) throw std::invalid_argument(why);
  return changed;
}

}  // namespace kenaf::python
