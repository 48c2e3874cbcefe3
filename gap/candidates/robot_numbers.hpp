// The numbers of a robot's description, found by the keys of its TOML file.
//
// Thread safety: values and pure functions; RobotNumber's functions may be called by any thread.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "physics/robot_description.hpp"

namespace kenaf::gap::candidates {

struct NumberRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open_min = false;  // min itself is out
};

// Keys are written as in the file: "drive.max_force_n", "body.center_of_mass_m[2]", "effects.command_gain.gain"; of a
// sensor with its name, "sensor[INS].delay_s". Two are derived, for what a robot is measured by:
// - "track.separation_m", between the centre planes of the tracks: twice the y of left_center_m;
// - "track.contact_length_m", of the flat belly: length_m less both end radii. The ends keep their radius.
struct RobotNumber {
  std::string key;
  std::string written_as;  // the key in the file that has it; `key` itself, but of a derived one
  NumberRange range;       // what parse_robot() accepts of this number by itself
  std::function<double(const physics::RobotDescription&)> get;
  std::function<void(physics::RobotDescription&, double)> set;  // to what get() returns: changes no bit
};

// Of this robot: no flipper's without flippers. Not among them: whole numbers, noise, cameras, ray sensors, [can], and
// command_loss, which is chance.
std::vector<RobotNumber> robot_numbers(const physics::RobotDescription& robot);
// Empty: this robot has no such number.
std::optional<RobotNumber> find_robot_number(const physics::RobotDescription& robot, std::string_view key);

// Why parse_robot() would refuse this robot's numbers, each or together: "track.length_m is 0.1, but must be more than
// twice track.end_radius_m". Empty: it would not.
std::string why_impossible(const physics::RobotDescription& robot);

}  // namespace kenaf::gap::candidates
