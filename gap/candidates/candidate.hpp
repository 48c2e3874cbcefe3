// Possible causes of a gap: every number by which a robot can differ from its nominal model.
//
// Thread safety: values and pure functions; Candidate::set may be called by any number of threads, each on a robot of
// its own.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "physics/robot_description.hpp"

namespace kenaf::gap::candidates {

// One number that may cause a gap, how it changes a robot, and its search range. It is a parameter of a catalogue
// effect, a number of the robot's description, or a user-defined effect (own_effects.hpp).
struct Candidate {
  // Unique. "command_slew"; for an effect with several parameters "command_slew:slowness_s2pm"; for a number of the
  // description its key, "track.separation_m", "body.inertia_kgm2[1]", "sensor[INS].delay_s".
  std::string name;
  std::string effect;     // as a report names it: "command_slew" for the catalogue, else `name`
  std::string parameter;  // "slowness_s2pm"; for a number of the description the last word of its key, "separation_m"
  std::string unit;       // "m", "s^2/m"; "1" for a ratio
  std::string summary;    // one line
  physics::Stage stage = physics::Stage::body;
  double neutral = 0;       // value without the effect; for a number of the description, the described value
  double present = 0;       // value in the robot it was made for; set() to this value changes no bit of that robot
  double min = 0, max = 0;  // search range for a robot of this size; min < max, contains neutral and present
  bool is_number_of_description = false;
  // Change of this candidate for a 100 % error of its number of the description; where that number is 0, for an error
  // of its range (0.2 s for a sensor's delay). Also set for an effect that leave_out() kept in place of the number. 0:
  // no such number.
  double whole = 0;
  // `effect` of another candidate that changes a run in the same way, as a scale or an offset of this number, or so
  // nearly that no run can distinguish them. Empty: none. Only one of the two is needed.
  std::string same_as;
  // `effect` of a candidate that multiplies this number and others by one factor: for the friction of the main belts,
  // the friction of all belts. Empty: none.
  std::string part_of;
  // Keys of the robot's TOML file that set() changes: "effects.command_slew.slowness_s2pm", "track.left_center_m[1]".
  std::vector<std::string> keys;
  // Whether set() moves what it finds, as a user-defined effect does, rather than replaces it: to be called after the
  // others.
  bool is_relative = false;
  // Sets it to `value`; call once per robot. The robot must be the one it was made for; other candidates may be set
  // already.
  std::function<void(physics::RobotDescription&, double value)> set;
};

// Whether `whole` changes this number too, and others with it (Candidate::part_of).
bool is_part_of(const Candidate& part, const Candidate& whole);

// Parameters of the catalogue's effects that this robot can show: none of flippers, lugs or sensors that it lacks,
// those of obstacles only if the world has any, and never command_loss, which is random. Search ranges of lengths,
// forces and slownesses scale with the robot's mass, length and speed, within the catalogue's range; ratios, angles and
// unknown parameters have the catalogue's range.
std::vector<Candidate> catalogue_candidates(const physics::RobotDescription& robot, bool has_obstacles);

// Every number of the description that changes the robot's motion or its recorded sensors, except noise, rates,
// resolutions, joint limits and ray sensors. parse_robot() accepts the robot at both ends of each range. Several
// numbers far from nominal may be rejected together (impossible moments of inertia), but tracks never overlap, and
// belts of tracks and flippers keep a straight run.
//
// Excluded because they change runs by rounding only: sprocket_radius_m (commands and recorded tracks are in metres)
// and the positions of INS and IMU (they change only accelerations, which the diagnosis does not read; a rotated or
// tilted orientation sensor is posture_mount or posture_bias).
std::vector<Candidate> description_candidates(const physics::RobotDescription& robot);

// Both of these.
std::vector<Candidate> all_candidates(const physics::RobotDescription& robot, bool has_obstacles);

// Removes candidates whose effect is named in `left_out` or equivalent to one named there. Of equivalent candidates
// keeps the first.
std::vector<Candidate> leave_out(std::vector<Candidate> all, std::span<const std::string> left_out);

}  // namespace kenaf::gap::candidates
