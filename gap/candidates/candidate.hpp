// temporary
#pragma once
#include <functional>
#include <string>
#include <vector>
#include "physics/robot_description.hpp"
namespace kenaf::gap {
struct Candidate {
  std::string name, effect, parameter, unit, summary;
  physics::Stage stage;
  double neutral, present, min, max;
  bool is_number_of_description;
  std::string same_as;
  std::function<void(physics::RobotDescription&, double)> set;
};
std::vector<Candidate> catalogue_candidates(const physics::RobotDescription& robot, bool has_obstacles);
}  // namespace kenaf::gap
