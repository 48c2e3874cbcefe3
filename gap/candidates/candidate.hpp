// What may be the cause of a gap: every number by which a robot can differ from its nominal model.
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

// One number that may be the cause of a gap: how it changes a robot, and how far it may go. Of three kinds: a parameter
// of an effect of the catalogue, a number of the robot's description, an effect of one's own (own_effects.hpp).
struct Candidate {
  // Unique. "command_slew"; of an effect with several parameters "command_slew:slowness_s2pm"; of a number of the
  // description its key, "track.separation_m", "body.inertia_kgm2[1]", "sensor[INS].delay_s".
  std::string name;
  std::string effect;     // as a report names it: of the catalogue "command_slew", else as `name`
  std::string parameter;  // "slowness_s2pm"; of a number of the description the last word of its key, "separation_m"
  std::string unit;       // "m", "s^2/m"; "1" for a ratio
  std::string summary;    // one line
  physics::Stage stage = physics::Stage::body;
  double neutral = 0;       // where the effect is not there; of a number of the description: as it is described
  double present = 0;       // of the robot that it was made for, whose every bit set() leaves as it is at this value
  double min = 0, max = 0;  // where to search, for a robot of this size; min < max, neutral and present within
  bool is_number_of_description = false;
  // By how much this is off where the number of the description is off by all of itself, or by its range where it is 0
  // (a sensor's delay by 0.2 s): of the number itself, and of an effect that leave_out() kept in its place. 0: there is
  // no such number.
  double whole = 0;
  // Another candidate's `effect` that changes a run in the same way, by a scale or an offset where this is the number
  // itself, or so nearly that no run tells them apart. Empty: there is none. Of two such, one is enough.
  std::string same_as;
  // The `effect` of a candidate that multiplies this number and others by one factor: of the friction of the main belts
  // that of all belts. Empty: there is none.
  std::string part_of;
  // Keys of the robot's TOML file that set() changes: "effects.command_slew.slowness_s2pm", "track.left_center_m[1]".
  std::vector<std::string> keys;
  // Makes it `value`, once on a robot. The robot is the one that it was made for, on which other candidates may be set.
  std::function<void(physics::RobotDescription&, double value)> set;
};

// Whether `whole` changes this number too, and others with it (Candidate::part_of).
bool is_part_of(const Candidate& part, const Candidate& whole);

// Parameters of the catalogue's effects that this robot can show: no flippers', no lugs' and no sensor's that it does
// not have, obstacles' only where the world has any; never command_loss, which is chance. Lengths, forces and
// slownesses are searched as far as they make sense for a robot of this mass, length and speed, never beyond the
// catalogue's own range; ratios, angles and what is not known here over all of that.
std::vector<Candidate> catalogue_candidates(const physics::RobotDescription& robot, bool has_obstacles);

// Every number of the description that changes how the robot moves or what its recorded sensors report, but noise,
// rates, resolutions, a joint's limits and ray sensors. At both ends of each range the robot is one that parse_robot()
// accepts. With several of them far out it may not be one (moments of inertia that no body has), but tracks stay apart,
// and they and the flippers keep belts with a straight run.
//
// Not among them, because no run changes with them but by rounding: sprocket_radius_m (commands and recorded tracks are
// in metres), and where INS and IMU are mounted (only a recorded acceleration does, which no diagnosis reads; a posture
// sensor that is mounted turned or tilted is posture_mount, posture_bias).
std::vector<Candidate> description_candidates(const physics::RobotDescription& robot);

// Both of these.
std::vector<Candidate> all_candidates(const physics::RobotDescription& robot, bool has_obstacles);

// Without those whose effect is named in `left_out`, or which do the same as one named there; of candidates that do the
// same, the first.
std::vector<Candidate> leave_out(std::vector<Candidate> all, std::span<const std::string> left_out);

}  // namespace kenaf::gap::candidates
