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
  bool open_min = false;  // min itself is excluded
};

// Keys are written as in the file: "drive.max_force_n", "body.center_of_mass_m[2]", "effects.command_gain.gain";
// sensors by name, "sensor[INS].delay_s"; wheels as wheel_numbers.hpp has them. Two are derived, as a robot on tracks
// is usually measured by them:
// - "track.separation_m", between the centre planes of the tracks: twice the y of left_center_m;
// - "track.contact_length_m", of the flat belly: length_m less both end radii. The ends keep their radius.
struct RobotNumber {
  std::string key;
  std::vector<std::string> written_as;  // the keys in the file that set() changes; just `key` but for derived numbers
  NumberRange range;                    // the values that parse_robot() accepts for this number alone
  std::function<double(const physics::RobotDescription&)> get;
  std::function<void(physics::RobotDescription&, double)> set;  // setting the value that get() returns changes no bit
};

// All numbers of this robot. Excluded: flippers, tracks or wheels if it has none, integers, noise, cameras, ray
// sensors, [can], and command_loss, which is random.
std::vector<RobotNumber> robot_numbers(const physics::RobotDescription& robot);
// Returns nothing if this robot has no such number.
std::optional<RobotNumber> find_robot_number(const physics::RobotDescription& robot, std::string_view key);

// Why parse_robot() would reject this robot's numbers, individually or together: "track.length_m is 0.1, but must be
// more than twice track.end_radius_m". Empty if it would accept them.
std::string why_impossible(const physics::RobotDescription& robot);

}  // namespace kenaf::gap::candidates
