#include <fmt/format.h>

#include <cmath>
#include <set>
#include <string_view>

#include "gap/candidates/candidate.hpp"
#include "gap/candidates/robot_numbers.hpp"
#include "gap/candidates/search_range.hpp"

namespace kenaf::gap::candidates {
namespace {

using physics::RobotDescription;
using physics::Stage;

constexpr double kLongestConstant_s = 2, kLongestReport_s = 0.6;
// A sensor described as having no delay is late by a few per cent of this: by one sample at 200 Hz (chosen).
constexpr double kUsualReport_s = 0.2;
constexpr double kJustInside = 0.99;  // for limits that are excluded

struct DescribedNumber {
  std::string_view key, unit;
  Stage stage;
  std::string_view summary;
  SearchRange (*range)(const RobotDescription&, double value);
  std::string_view same_as = {};
  std::optional<double> whole_of_nothing = {};  // Candidate::whole where the number is 0; empty: its range
};

SearchRange doubled(const RobotDescription&, double value) {
  return half_to_twice(value);
}

// Numbers that a description often only guesses because the robot's data sheet does not state them.
SearchRange tenfold(const RobotDescription&, double value) {
  return {value / 10, value * 5};
}

// Moments of inertia possible for a rigid body with the two others given: |I_a - I_b| <= I <= I_a + I_b.
template <int axis>
SearchRange moment(const RobotDescription& robot, double value) {
  const double a = robot.body.inertia_kgm2[(axis + 1) % 3], b = robot.body.inertia_kgm2[(axis + 2) % 3];
  return within(half_to_twice(value), {std::abs(a - b), a + b});
}

// A fixed fraction of the track's length to both sides.
SearchRange along(const RobotDescription& robot, double value) {
  return {value - 0.15 * robot.track_length_m(), value + 0.15 * robot.track_length_m()};
}
SearchRange upward(const RobotDescription& robot, double value) {
  return {value - 0.09 * robot.track_length_m(), value + 0.15 * robot.track_length_m()};
}
SearchRange across(const RobotDescription& robot, double value) {
  const double reach = std::min(0.15 * robot.track_length_m(), 0.25 * robot.track_gauge_m());
  return {value - reach, value + reach};
}
// Half of the end radius: beyond it the hull would touch the ground or be far above it.
SearchRange height(const RobotDescription& robot, double value) {
  return {value - robot.track.front().end_radius_m / 2, value + robot.track.front().end_radius_m / 2};
}

// Two numbers with a fixed order may each go half way to the other, so that both can do so at once.
double between_length_and_ends_m(const RobotDescription& robot) {
  return robot.track.front().length_m / 2 + robot.track.front().end_radius_m;
}
double between_separation_and_width_m(const RobotDescription& robot) {
  return (robot.track_gauge_m() + robot.track.front().width_m) / 2;
}
SearchRange track_length(const RobotDescription& robot, double value) {
  return {std::max(value / 2, between_length_and_ends_m(robot)), 2 * value};
}
SearchRange contact_length(const RobotDescription& robot, double value) {
  const double ends_m = 2 * robot.track.front().end_radius_m;
  const SearchRange length = track_length(robot, value + ends_m);
  return {length.min - ends_m, length.max - ends_m};
}
SearchRange end_radius(const RobotDescription& robot, double value) {
  return within(half_to_twice(value), {0, kJustInside * between_length_and_ends_m(robot) / 2});
}
SearchRange separation(const RobotDescription& robot, double value) {
  return {std::max(value / 2, between_separation_and_width_m(robot)), 2 * value};
}
SearchRange track_width(const RobotDescription& robot, double value) {
  return within(half_to_twice(value), {0, kJustInside * between_separation_and_width_m(robot)});
}

// The hull fits between the tracks and stays off level ground.
SearchRange hull_length(const RobotDescription&, double value) {
  return {0.5 * value, 1.5 * value};
}
SearchRange hull_width(const RobotDescription& robot, double value) {
  return within(half_to_twice(value), {0, robot.track_gauge_m() - robot.track.front().width_m});
}
SearchRange hull_height(const RobotDescription& robot, double value) {
  return within(half_to_twice(value), {0, 2 * (robot.ride_height_m())});
}

// The arm stays longer than the difference of the drum radii, even with all three numbers at the ends of their ranges.
double slack_m(const physics::FlipperDescription& flipper) {
  return flipper.length_m - std::abs(flipper.pivot_radius_m - flipper.tip_radius_m);
}
SearchRange flipper_length(const RobotDescription& robot, double value) {
  return {std::max(value / 2, value - slack_m(robot.flipper.front()) / 2), 2 * value};
}
SearchRange drum_radius(const RobotDescription& robot, double value) {
  const double reach = kJustInside * slack_m(robot.flipper.front()) / 4;
  return within(half_to_twice(value), {value - reach, value + reach});
}
SearchRange pivot_ahead(const RobotDescription& robot, double value) {
  return within(half_to_twice(value), along(robot, value));
}

// Up to 3 % of the end radius at least, so a robot described without lugs may have some.
SearchRange lugs(const RobotDescription& robot, double value) {
  return {0, std::max(3 * value, 0.03 * robot.track.front().end_radius_m)};
}
// As that of the effect, and beyond a description that has much of it.
SearchRange shear(const RobotDescription& robot, double value) {
  return {0, std::max(3 * value, 0.15 * robot.track.front().length_m)};
}
SearchRange time_constant(const RobotDescription&, double value) {
  return {0, std::max(kLongestConstant_s, value)};
}
SearchRange report_delay(const RobotDescription&, double value) {
  return {0, std::max(kLongestReport_s, value)};
}
// The voltage falls to a sixth while both tracks are stalled; 5 ohm if the description has no currents.
SearchRange resistance(const RobotDescription& robot, double value) {
  const double stalled_a = 2 * robot.drive.amperes_per_newton * robot.drive.max_force_n;
  const double more_ohm = stalled_a > 0 ? std::min(5.0, 5 * robot.battery.open_circuit_v / stalled_a) : 5;
  return {0, value + more_ohm};
}

constexpr DescribedNumber kDescribed[] = {
    {"body.mass_kg", "kg", Stage::body, "mass of the body, whose moments of inertia stay", doubled, "mass"},
    {"body.center_of_mass_m[0]", "m", Stage::body, "position of the body's centre of mass along x", along,
     "com_forward"},
    {"body.center_of_mass_m[1]", "m", Stage::body, "position of the body's centre of mass along y", across, "com_left"},
    {"body.center_of_mass_m[2]", "m", Stage::body, "height of the body's centre of mass", upward, "com_up"},
    {"body.inertia_kgm2[0]", "kg m^2", Stage::body, "moment of inertia of the body about x", moment<0>, "roll_inertia"},
    {"body.inertia_kgm2[1]", "kg m^2", Stage::body, "moment of inertia of the body about y", moment<1>,
     "pitch_inertia"},
    {"body.inertia_kgm2[2]", "kg m^2", Stage::body, "moment of inertia of the body about z", moment<2>, "yaw_inertia"},
    {"body.size_m[0]", "m", Stage::body, "length of the hull between the tracks", hull_length},
    {"body.size_m[1]", "m", Stage::body, "width of the hull between the tracks", hull_width},
    {"body.size_m[2]", "m", Stage::body, "height of the hull between the tracks", hull_height},
    {"body.friction", "1", Stage::contact, "friction of the hull", doubled},
    {"track.length_m", "m", Stage::body, "length of the tracks over both ends", track_length},
    {"track.contact_length_m", "m", Stage::body, "length of the tracks' flat belly", contact_length, "track.length_m"},
    {"track.end_radius_m", "m", Stage::body, "radius of the tracks' ends, which sets the ride height", end_radius},
    {"track.width_m", "m", Stage::body, "width of the belts", track_width},
    {"track.separation_m", "m", Stage::body, "distance between the tracks' centre planes", separation},
    {"track.left_center_m[0]", "m", Stage::body, "position of the tracks along x", along},
    {"track.left_center_m[2]", "m", Stage::body, "height of the tracks on the body", height},
    {"track.friction_along", "1", Stage::contact, "friction of the main belts in rolling direction", doubled,
     "friction_along"},
    {"track.friction_across", "1", Stage::contact, "friction of the main belts across", doubled, "friction_across"},
    {"track.lug_height_m", "m", Stage::contact, "height of the lugs that catch at an edge", lugs, "lug_height"},
    {"track.shear_deformation_m", "m", Stage::contact, "shear displacement over which the belts' friction builds up",
     shear, "shear_deformation"},
    {"wheel.base_m", "m", Stage::body, "distance of the front and rear axles", doubled},
    {"wheel.radius_m", "m", Stage::body, "radius of the wheels, which sets the ride height", doubled},
    {"wheel.width_m", "m", Stage::body, "width of the wheels", track_width},
    {"wheel.separation_m", "m", Stage::body, "distance between the left and right wheels' centre planes", separation},
    {"wheel.forward_m", "m", Stage::body, "position of the wheels along x", along},
    {"wheel.up_m", "m", Stage::body, "height of the wheels on the body", height},
    {"wheel.friction_along", "1", Stage::contact, "friction of the wheels in rolling direction", doubled,
     "friction_along"},
    {"wheel.friction_across", "1", Stage::contact, "friction of the wheels across", doubled, "friction_across"},
    {"caster.friction", "1", Stage::contact, "friction of the casters", doubled},
    {"drive.max_speed_mps", "m/s", Stage::drive, "the track motors' speed without load", doubled},
    {"drive.max_force_n", "N", Stage::drive, "the track motors' force at standstill", doubled, "drive_torque_limit"},
    {"drive.time_constant_s", "s", Stage::drive, "first-order lag of the track's speed loop", time_constant},
    {"drive.moving_mass_kg", "kg", Stage::drive, "inertia of belt, gear and rotor, referred to the belt", doubled},
    {"drive.amperes_per_newton", "A/N", Stage::drive, "motor current for a belt force", tenfold},
    {"drive.idle_amperes", "A", Stage::drive, "motor current of a track that runs without load", tenfold},
    {"battery.open_circuit_v", "V", Stage::drive, "voltage of the battery without load", doubled},
    {"battery.internal_resistance_ohm", "ohm", Stage::drive,
     "internal resistance, which lowers the battery voltage under load", resistance, "battery_sag"},
    {"flipper.mass_kg", "kg", Stage::body, "mass of each flipper", doubled},
    {"flipper.length_m", "m", Stage::body, "length of the flippers, from pivot to tip drum", flipper_length},
    {"flipper.pivot_radius_m", "m", Stage::body, "radius of the flippers' drums at the pivot", drum_radius},
    {"flipper.tip_radius_m", "m", Stage::body, "radius of the flippers' drums at the tip", drum_radius},
    {"flipper.width_m", "m", Stage::body, "width of the flippers' belts", doubled},
    {"flipper.front_left_pivot_m[0]", "m", Stage::body, "distance of the flippers' pivots from the centre along x",
     pivot_ahead},
    {"flipper.front_left_pivot_m[1]", "m", Stage::body, "distance of the flippers' pivots from the centre along y",
     across},
    {"flipper.front_left_pivot_m[2]", "m", Stage::body, "height of the flippers' pivots on the body", height},
    {"flipper.friction_along", "1", Stage::contact, "friction of the flippers' belts in rolling direction", doubled},
    {"flipper.friction_across", "1", Stage::contact, "friction of the flippers' belts across", doubled},
    {"servo.max_speed_radps", "rad/s", Stage::drive, "the flipper servos' speed", doubled},
    {"servo.max_torque_nm", "N m", Stage::drive, "the flipper servos' torque", doubled, "flipper_torque_limit"},
    {"servo.amperes_per_nm", "A/(N m)", Stage::drive, "the flipper servos' current for a torque", doubled},
};

// Empty for sensor types that runs do not record. A second sensor of a type is not recorded either.
std::string_view delayed(physics::SensorType type) {
  switch (type) {
    case physics::SensorType::ins:
      return "the orientation sensor reports late";
    case physics::SensorType::imu:
      return "gyro and acceleration are reported late";
    case physics::SensorType::encoder:
      return "the tracks' travel is reported late";
    case physics::SensorType::tachometer:
      return "the tracks' speeds are reported late";
    case physics::SensorType::drives:
      return "currents, voltage and flipper angles are reported late";
    default:
      return {};
  }
}
std::string_view same_delay(physics::SensorType type) {
  return type == physics::SensorType::ins ? "posture_delay" : type == physics::SensorType::imu ? "gyro_delay" : "";
}

std::string last_word(const std::string& key) {
  return key.substr(key.rfind('.') + 1);
}

// Effects of friction also change the flippers' belts.
bool does_more(std::string_view effect, const RobotDescription& robot) {
  return effect.starts_with("friction_") && robot.has_flippers();
}
// An effect is equivalent only if it exists and changes nothing else.
bool does_the_same(std::string_view effect, const RobotDescription& robot) {
  if (does_more(effect, robot)) return false;
  if (effect == "lug_height" && robot.track.front().lug_height_m == 0) return false;
  return effect.starts_with("track.") || physics::find_effect(effect) != nullptr;
}

// Flippers whose belts do not run are skids, with the friction across in all directions.
bool has_no_influence(const std::string& key, const RobotDescription& robot) {
  return key == "flipper.friction_along" && robot.has_flippers() && !robot.flipper.front().belt_driven;
}

// `end`, or what is possible on the way there from the present value: pairs of wheels may differ, so that a common
// number reaches the limit of one of them before that of the others.
double possible_end(const RobotDescription& robot, const RobotNumber& number, double present, double end) {
  const auto is_possible = [&](double value) {
    RobotDescription varied = robot;
    number.set(varied, value);
    return why_impossible(varied).empty();
  };
  if (is_possible(end)) return end;
  constexpr int kHalvings = 30;
  double possible = present, impossible = end;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (possible + impossible) / 2;
    (is_possible(middle) ? possible : impossible) = middle;
  }
  return possible;
}

// Adds nothing if the range is empty: half and twice of 0 are 0.
void add_candidate(std::vector<Candidate>& candidates, const DescribedNumber& described, const std::string& key,
                   const RobotDescription& robot) {
  const std::optional<RobotNumber> number = find_robot_number(robot, key);
  if (!number || has_no_influence(key, robot)) return;
  const double value = number->get(robot);
  SearchRange range = with(within(described.range(robot, value), {number->range.min, number->range.max}), value);
  range = {possible_end(robot, *number, value, range.min), possible_end(robot, *number, value, range.max)};
  if (!(range.min < range.max)) return;
  Candidate candidate;
  candidate.name = candidate.effect = key;
  candidate.parameter = last_word(key);
  candidate.unit = described.unit;
  candidate.summary = described.summary;
  candidate.stage = described.stage;
  candidate.neutral = candidate.present = value;
  candidate.min = range.min;
  candidate.max = range.max;
  candidate.is_number_of_description = true;
  candidate.whole = value != 0 ? std::abs(value) : described.whole_of_nothing.value_or(range.max - range.min);
  if (does_the_same(described.same_as, robot)) candidate.same_as = described.same_as;
  if (does_more(described.same_as, robot)) candidate.part_of = described.same_as;
  candidate.keys = number->written_as;
  candidate.set = number->set;
  candidates.push_back(std::move(candidate));
}

}  // namespace

std::vector<Candidate> description_candidates(const RobotDescription& robot) {
  std::vector<Candidate> candidates;
  for (const DescribedNumber& described : kDescribed)
    add_candidate(candidates, described, std::string(described.key), robot);
  std::set<physics::SensorType> recorded;
  for (const physics::SensorDescription& sensor : robot.sensors) {
    const std::string_view summary = delayed(sensor.type);
    if (summary.empty() || !recorded.insert(sensor.type).second) continue;
    const std::string key = fmt::format("sensor[{}].delay_s", sensor.name);
    add_candidate(candidates, {key, "s", Stage::sensor, summary, report_delay, same_delay(sensor.type), kUsualReport_s},
                  key, robot);
  }
  return candidates;
}

}  // namespace kenaf::gap::candidates
