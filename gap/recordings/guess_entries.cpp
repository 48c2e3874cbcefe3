#include "gap/recordings/guess_entries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "gap/recordings/field_path.hpp"
#include "gap/recordings/message_definition.hpp"
#include "gap/recordings/name_words.hpp"
#include "robot/columns.hpp"

namespace kenaf::gap::recordings {
namespace {

constexpr int kNoPose = -2;                // rank of a frame that is not the robot's
constexpr int kOwnName = 100;              // rank of a column that has the name of a run's
constexpr double kLargestAngle_rad = 6.5;  // a joint beyond a whole turn is in degrees

bool is_commanded(const Words& words) {
  return has_any(words, {"cmd", "command", "commanded", "commands", "target", "setpoint", "desired", "ref", "goal"});
}

bool is_joint_state(const SurveyedTopic& topic) {
  return short_type(topic.topic.type) == "sensor_msgs/JointState";
}

// The name as far as it says what a number is: the topic's words and the field's.
struct Looked {
  const SurveyedTopic& topic;
  const Signal& signal;
  Words words, last;  // of the whole, and of the part behind the last dot or slash
};

// The axis at the end of a name, before its unit of at most two words: "gyro_z_rad_s".
std::string axis_at_end(const Words& words) {
  constexpr std::size_t kUnitWords = 2;
  for (std::size_t i = 0; i < words.size() && i <= kUnitWords; ++i) {
    const std::string& word = words[words.size() - 1 - i];
    if (word == "x" || word == "y" || word == "z") return word;
  }
  return {};
}

// A column's name with its side or corner in the place of '*'.
std::string with_side(std::string_view pattern, std::string_view side) {
  const std::size_t star = pattern.find('*');
  return std::string(pattern.substr(0, star)).append(side).append(pattern.substr(star + 1));
}

// ROS defines the units of its own messages (REP 103).
bool has_defined_units(const SurveyedTopic& topic) {
  constexpr std::string_view kTypes[] = {"sensor_msgs/JointState", "sensor_msgs/Imu", "sensor_msgs/BatteryState"};
  return std::ranges::find(kTypes, short_type(topic.topic.type)) != std::end(kTypes);
}

ColumnGuess made(const Looked& looked, const std::string& column, const std::string& unit, const std::string& why,
                 const std::string& check, int rank) {
  const bool sure = rank == kOwnName || has_defined_units(looked.topic) || !unit_in(looked.signal.path).empty();
  return {column, looked.signal.from, unit, why, check, sure, &looked.topic, rank};
}

// ---- rules, each for one signal

std::optional<ColumnGuess> own_column(const Looked& looked) {
  const std::string& name = looked.signal.path;
  const robot::Column* known = robot::find_column(name);
  if (known == nullptr || name == "t_s") return std::nullopt;
  return made(looked, name, std::string(known->unit), "it has the column's own name", "", kOwnName);
}

std::optional<ColumnGuess> flipper(const Looked& looked) {
  const std::string corner = corner_in(looked.words);
  if (corner.empty() || !has_any(looked.words, {"flipper", "flippers", "arm", "paddle"})) return std::nullopt;
  if (has_any(looked.words, {"current", "amps"}))
    return made(looked, with_side("flipper_*_a", corner), unit_in(looked.signal.path) == "mA" ? "mA" : "A",
                "a current of a flipper", "", 50);
  if (!has_any(looked.words, {"position", "angle", "pos", "rad", "deg"}) ||
      has_any(looked.words, {"velocity", "effort", "speed"}))
    return std::nullopt;
  const bool in_degrees = unit_in(looked.signal.path) == "deg" || looked.signal.most > kLargestAngle_rad ||
                          looked.signal.least < -kLargestAngle_rad;
  return made(looked, with_side(is_commanded(looked.words) ? "cmd_flipper_*_rad" : "flipper_*_rad", corner),
              in_degrees ? "deg" : "rad", "an angle of a flipper",
              "0 is straight out along the body, positive with the tip up", 50);
}

// The side of a drive: by its name, or in a list of two drivers by its place.
std::optional<Side> side_of_drive(const Looked& looked, bool& by_place) {
  by_place = false;
  if (const auto side = side_in(looked.words)) return side;
  if (!has_any(looked.words, {"drivers", "motors", "wheels", "tracks", "drives"})) return std::nullopt;
  by_place = true;
  const std::string& path = looked.signal.path;
  if (path.find("[0]") != path.npos) return Side::left;
  return path.find("[1]") != path.npos ? std::optional(Side::right) : std::nullopt;
}

// The unit of a speed or travel: as its name says, or as its message has it.
std::string belt_unit(const Looked& looked, bool is_speed) {
  std::string named = unit_in(looked.signal.path);
  if (!named.empty()) return named;
  const bool turns =
      is_joint_state(looked.topic) || has_any(looked.words, {"wheel", "sprocket", "motor", "drivers", "motors"});
  if (is_speed) return turns ? "rad/s" : "m/s";
  return turns ? "rad" : "m";
}

std::optional<ColumnGuess> track(const Looked& looked) {
  bool by_place = false;
  const std::optional<Side> side = side_of_drive(looked, by_place);
  if (!side || has_any(looked.words, {"flipper", "flippers", "arm", "paddle", "temperature", "camera", "steering"}))
    return std::nullopt;
  const std::string name = *side == Side::left ? "left" : "right";
  const bool is_belt = has_any(looked.words, {"track", "tracks", "belt", "tread"});
  // Takes the front one of several wheels on a side; any would do.
  const int rank = (is_belt ? 45 : 40) - (has_any(looked.words, {"rear", "back", "mid", "middle"}) ? 5 : 0);
  const std::string check = by_place ? "whether [0] is left" : "its sign: positive forward";
  if (has_any(looked.words, {"current", "amps", "amperes"}))
    return made(looked, with_side("track_*_a", name), unit_in(looked.signal.path) == "mA" ? "mA" : "A",
                "a current of one side", by_place ? check : "", rank);
  if (has_any(looked.words, {"velocity", "vel", "speed", "rpm", "mps", "radps"}))
    return made(looked, with_side(is_commanded(looked.words) ? "cmd_track_*_mps" : "track_*_mps", name),
                belt_unit(looked, true), "a speed of one side", check, rank);
  if (has_any(looked.words, {"travel", "distance", "position", "odometer"}) && !is_commanded(looked.words))
    return made(looked, with_side("track_*_m", name), belt_unit(looked, false), "the travel of one side", check, rank);
  return std::nullopt;
}

std::optional<ColumnGuess> inertial(const Looked& looked) {
  const std::string axis = axis_at_end(looked.last);
  if (axis.empty() || has_any(looked.words, {"covariance", "twist", "orientation", "bias"})) return std::nullopt;
  const bool is_imu = has_any(looked.words, {"imu", "gyro", "acc", "accel"}) ||
                      short_type(looked.topic.topic.type) == "sensor_msgs/Imu";
  const bool rates =
      has_any(looked.last, {"gyro"}) || (has_any(looked.words, {"angular"}) && has_any(looked.words, {"velocity"}));
  const bool accelerations = has_any(looked.words, {"acceleration", "acc", "accel"});
  if (!is_imu || rates == accelerations) return std::nullopt;
  const std::string unit = unit_in(looked.signal.path);
  const int rank = 30 - (has_any(looked.words, {"raw"}) ? 1 : 0);
  if (rates)
    return made(looked, "gyro_" + axis + "_radps", unit == "deg/s" ? unit : "rad/s",
                "a turn rate of an inertial sensor", "the sensor's axes are the robot's: x forward, y left, z up",
                rank);
  return made(looked, "acc_" + axis + "_mps2", unit == "g" ? unit : "m/s^2", "an acceleration of an inertial sensor",
              axis == "z" ? "at rest on level ground it reads +9.81" : "", rank);
}

// Turn rates and accelerations of a sensor S in the form of EuRoC: "w_RS_S_x [rad s^-1]", "a_RS_S_x [m s^-2]".
std::optional<ColumnGuess> euroc_inertial(const Looked& looked) {
  const std::string& name = looked.signal.path;
  const bool rates = name.starts_with("w_RS_S_"), accelerations = name.starts_with("a_RS_S_");
  if ((!rates && !accelerations) || name.size() < 8 || name[7] < 'x' || name[7] > 'z') return std::nullopt;
  const std::string axis(1, name[7]), check = axis == "x" ? "the sensor's axes are the robot's" : "";
  if (rates) return made(looked, "gyro_" + axis + "_radps", "rad/s", "a turn rate of EuRoC", check, 30);
  return made(looked, "acc_" + axis + "_mps2", "m/s^2", "an acceleration of EuRoC", check, 30);
}

std::optional<ColumnGuess> battery(const Looked& looked) {
  const bool is_voltage = has_any(looked.words, {"voltage", "vbat", "volts"});
  const bool of_cell = has_any(looked.words, {"cell", "cells", "motor", "driver", "drivers"});
  const bool of_battery = has_any(looked.words, {"battery", "bat", "batt", "vbat", "supply"});
  if (!is_voltage || of_cell || !of_battery) return std::nullopt;
  return made(looked, "battery_v", unit_in(looked.signal.path) == "mV" ? "mV" : "V", "the voltage of the battery", "",
              30);
}

void take_column(const Looked& looked, GuessedEntries& entries) {
  for (const auto rule : {own_column, flipper, track, inertial, euroc_inertial, battery}) {
    std::optional<ColumnGuess> guess = rule(looked);
    if (!guess) continue;
    const auto known = entries.columns.find(guess->column);
    if (known == entries.columns.end() || guess->rank > known->second.rank)
      entries.columns.insert_or_assign(guess->column, std::move(*guess));
    return;
  }
}

const Signal* signal_from(const SurveyedTopic& topic, const std::string& from) {
  const auto found = std::ranges::find(topic.signals, from, &Signal::from);
  return found == topic.signals.end() ? nullptr : &*found;
}

// `text` with its last `what` replaced.
std::string with_last(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.rfind(what);
  return at == text.npos ? std::string() : text.replace(at, what.size(), by);
}

// v and w: fields linear x and angular z of one message, or columns named so.
std::string turn_rate_beside(const SurveyedTopic& topic, const Looked& looked) {
  const std::size_t words = looked.last.size();
  std::string partner;
  if (words >= 2 && looked.last[words - 2] == "linear" && looked.last.back() == "x") {
    partner = with_last(with_last(looked.signal.from, "linear", "angular"), "x", "z");
  } else if (looked.signal.from == "v" || looked.signal.from.ends_with("_v") || looked.signal.from.starts_with("v_")) {
    for (const char* name : {"w", "omega"}) {
      partner = with_last(looked.signal.from, "v", name);
      if (signal_from(topic, partner) != nullptr) break;
    }
  }
  return partner.empty() || signal_from(topic, partner) == nullptr ? std::string() : partner;
}

void take_drive(const Looked& looked, GuessedEntries& entries) {
  const std::string w = turn_rate_beside(looked.topic, looked);
  if (w.empty()) return;
  const bool commanded = is_commanded(looked.words);
  // Takes the command that is sent most often, and a measured speed that is not called filtered.
  const int rank = commanded ? static_cast<int>(std::min<std::uint64_t>(looked.topic.topic.count, 1000000))
                   : has_any(looked.words, {"filtered", "ekf", "fused"}) ? 1
                                                                         : 2;
  DriveGuess guess{commanded,
                   looked.signal.from,
                   w,
                   commanded ? "speed and turn rate that are commanded" : "speed and turn rate that are measured",
                   commanded ? "whether the robot obeys this topic" : "whether they come from the tracks' encoders",
                   &looked.topic,
                   rank};
  const auto known = entries.drives.find(commanded);
  if (known == entries.drives.end() || rank > known->second.rank)
    entries.drives.insert_or_assign(commanded, std::move(guess));
}

// Sources of `names` behind a common begin; empty if one is missing.
std::vector<std::string> all_behind(const SurveyedTopic& topic, const std::string& begin,
                                    const std::vector<std::string>& names) {
  std::vector<std::string> found;
  for (const std::string& name : names) {
    if (signal_from(topic, begin + name) == nullptr) return {};
    found.push_back(begin + name);
  }
  return found;
}

struct PoseNames {
  const char* w;  // the end of the rotation's w
  std::vector<std::string> position, rotation;
};

const std::vector<PoseNames>& pose_names() {
  static const std::vector<PoseNames> names = {
      {"orientation.w",
       {"position.x", "position.y", "position.z"},
       {"orientation.x", "orientation.y", "orientation.z", "orientation.w"}},
      {"orientation/w",
       {"position/x", "position/y", "position/z"},
       {"orientation/x", "orientation/y", "orientation/z", "orientation/w"}},
      {"rotation.w",
       {"translation.x", "translation.y", "translation.z"},
       {"rotation.x", "rotation.y", "rotation.z", "rotation.w"}},
      {"rotation/w",
       {"translation/x", "translation/y", "translation/z"},
       {"rotation/x", "rotation/y", "rotation/z", "rotation/w"}},
      {"qw", {"x_m", "y_m", "z_m"}, {"qx", "qy", "qz", "qw"}},
      {"qw", {"x_mm", "y_mm", "z_mm"}, {"qx", "qy", "qz", "qw"}},
      {"qw", {"x", "y", "z"}, {"qx", "qy", "qz", "qw"}},
      {"qw", {"tx", "ty", "tz"}, {"qx", "qy", "qz", "qw"}},
      {"qw", {"px", "py", "pz"}, {"qx", "qy", "qz", "qw"}},
  };
  return names;
}

// How likely a pose is a measurement of the robot's body.
int rank_of_pose(const Words& words, std::string& why) {
  if (has_any(words, {"mocap", "vrpn", "vicon", "optitrack", "qualisys", "qtm", "truth"})) {
    why = "a pose of motion capture, or of ground truth";
    return 30;
  }
  if (has_any(words, {"slam", "lidar", "amcl", "localization", "localisation", "icp", "gps", "rtk", "map"})) {
    why = "a pose by lidar, satellites or a map";
    return 20;
  }
  if (has_any(words, {"odom", "odometry", "wheel", "encoder", "imu", "plan", "goal"})) {
    why = "a pose that the tracks' encoders may have made: no measurement of the body";
    return -1;
  }
  why = "a pose";
  return 10;
}

// In a list of transforms, only that to the robot's body is its pose, and from `odom` it is one of the encoders.
void judge_transform(const std::string& begin, PoseGuess& guess) {
  const std::size_t open = begin.find("transforms[");
  if (open == begin.npos) return;
  if (!has_any(words_in(begin.substr(open)), {"base", "body", "robot", "footprint"})) guess.rank = kNoPose;
  const bool has_odom = std::ranges::any_of(
      guess.topic->signals, [](const Signal& signal) { return signal.path.starts_with("transforms[odom]"); });
  if (has_odom && guess.rank > 0) {
    guess.rank = -1;
    guess.why = "a transform, probably from odom: no measurement of the body";
  } else if (guess.rank > 0) {
    guess.check = "that the transform is from the world; " + guess.check;
  }
}

void take_pose(const Looked& looked, GuessedEntries& entries) {
  for (const PoseNames& names : pose_names()) {
    const std::string& from = looked.signal.from;
    if (!from.ends_with(names.w)) continue;
    const std::string begin = from.substr(0, from.size() - std::string_view(names.w).size());
    const auto position = all_behind(looked.topic, begin, names.position),
               rotation = all_behind(looked.topic, begin, names.rotation);
    if (position.empty() || rotation.empty()) continue;
    PoseGuess guess{{begin, {position[0], position[1], position[2]}, rotation, "quaternion", "m", "", logs::Up::z},
                    "",
                    "the body's axes are the robot's: x forward, y left, origin at the body's centre",
                    &looked.topic,
                    0};
    if (names.position[0].ends_with("_mm")) guess.pose.unit = "mm";
    guess.rank = rank_of_pose(looked.words, guess.why);
    judge_transform(begin, guess);
    entries.poses.push_back(std::move(guess));
    return;
  }
}

bool has_all_columns(const SurveyedTopic& topic, const TablePose& pose) {
  const auto is_there = [&topic](const std::string& column) {
    return is_utf8(column) && signal_from(topic, column) != nullptr;
  };
  return std::ranges::all_of(pose.position, is_there) && std::ranges::all_of(pose.rotation, is_there);
}

// The words behind the topic; of a key in brackets too.
Looked look_at(const SurveyedTopic& topic, const Signal& signal) {
  return {topic, signal, words_in(signal.from), words_in(signal.path)};
}

}  // namespace

GuessedEntries guess_entries(const Survey& survey) {
  GuessedEntries entries;
  for (const SurveyedTopic& topic : survey.topics) {
    for (const Signal& signal : topic.signals) {
      if (!is_utf8(signal.from)) continue;
      const Looked looked = look_at(topic, signal);
      take_column(looked, entries);
      take_drive(looked, entries);
      take_pose(looked, entries);
    }
    for (const TablePose& pose : survey.poses) {
      if (!has_all_columns(topic, pose)) continue;  // as a body without its rotation
      const bool is_motion_capture = survey.form != "TUM" && survey.form != "EuRoC";
      entries.poses.push_back({pose, fmt::format("the body '{}' of {}", pose.body, survey.form),
                               is_motion_capture ? "which axis points up, and that the body's axes are the robot's"
                                                 : "that this is the robot's body, with z up",
                               &topic, 40, is_motion_capture});
    }
  }
  std::ranges::stable_sort(entries.poses, std::greater(), &PoseGuess::rank);
  return entries;
}

}  // namespace kenaf::gap::recordings
