#include "gap/candidates/robot_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gap/candidates/number_ranges.hpp"
#include "gap/candidates/wheel_numbers.hpp"

namespace kenaf::gap::candidates {
namespace {

using physics::BatteryDescription;
using physics::BodyDescription;
using physics::FlipperDescription;
using physics::FlipperServoDescription;
using physics::RobotDescription;
using physics::TrackDescription;
using physics::TrackDriveDescription;

// As in physics/robot_description.cpp.
constexpr NumberRange kLugRange{.min = 0, .max = 0.05};
constexpr NumberRange kShearRange{.min = 0, .max = 0.2};
constexpr NumberRange kDelayRange{.min = 0, .max = 10};
constexpr NumberRange kMinAngleRange{.min = -2 * std::numbers::pi, .max = 0};
constexpr NumberRange kMaxAngleRange{.min = 0, .max = 2 * std::numbers::pi};

constexpr int kNoVector = -1;

// A member of a section of the description; for a vector, its component `index`.
template <auto member, int index>
auto& number_in(auto& part) {
  if constexpr (index == kNoVector)
    return part.*member;
  else
    return (part.*member)[index];
}

// Works on const and non-const robots.
template <auto section, auto member, int index>
struct InSection {
  static auto& of(auto& robot) { return number_in<member, index>(robot.*section); }
};
template <auto member, int index = kNoVector>
struct Flipper {
  static auto& of(auto& robot) { return number_in<member, index>(robot.flipper.front()); }
};
template <auto member, int index = kNoVector>
struct Track {
  static auto& of(auto& robot) { return number_in<member, index>(robot.track.front()); }
};
template <auto member, int index = kNoVector>
using Body = InSection<&RobotDescription::body, member, index>;
template <auto member, int index = kNoVector>
using Drive = InSection<&RobotDescription::drive, member, index>;
template <auto member, int index = kNoVector>
using Servo = InSection<&RobotDescription::servo, member, index>;
template <auto member, int index = kNoVector>
using Battery = InSection<&RobotDescription::battery, member, index>;

template <class Place>
double read_at(const RobotDescription& robot) {
  return Place::of(robot);
}
template <class Place>
void write_at(RobotDescription& robot, double value) {
  Place::of(robot) = value;
}

struct PlainNumber {
  std::string_view key;
  NumberRange range;
  double (*read)(const RobotDescription&);
  void (*write)(RobotDescription&, double);

  template <class Place>
  constexpr PlainNumber(std::string_view name, NumberRange accepted, Place)
      : key(name), range(accepted), read(read_at<Place>), write(write_at<Place>) {}
};

constexpr PlainNumber kOfEveryRobot[] = {
    {"body.mass_kg", kAboveZero, Body<&BodyDescription::mass_kg>{}},
    {"body.size_m[0]", kAboveZero, Body<&BodyDescription::size_m, 0>{}},
    {"body.size_m[1]", kAboveZero, Body<&BodyDescription::size_m, 1>{}},
    {"body.size_m[2]", kAboveZero, Body<&BodyDescription::size_m, 2>{}},
    {"body.center_of_mass_m[0]", kAnyNumber, Body<&BodyDescription::p_BBcm_m, 0>{}},
    {"body.center_of_mass_m[1]", kAnyNumber, Body<&BodyDescription::p_BBcm_m, 1>{}},
    {"body.center_of_mass_m[2]", kAnyNumber, Body<&BodyDescription::p_BBcm_m, 2>{}},
    {"body.inertia_kgm2[0]", kAboveZero, Body<&BodyDescription::inertia_kgm2, 0>{}},
    {"body.inertia_kgm2[1]", kAboveZero, Body<&BodyDescription::inertia_kgm2, 1>{}},
    {"body.inertia_kgm2[2]", kAboveZero, Body<&BodyDescription::inertia_kgm2, 2>{}},
    {"body.friction", kFrictionRange, Body<&BodyDescription::friction>{}},
    {"drive.sprocket_radius_m", kAboveZero, Drive<&TrackDriveDescription::sprocket_radius_m>{}},
    {"drive.max_speed_mps", kAboveZero, Drive<&TrackDriveDescription::max_speed_mps>{}},
    {"drive.max_force_n", kAboveZero, Drive<&TrackDriveDescription::max_force_n>{}},
    {"drive.time_constant_s", kZeroOrMore, Drive<&TrackDriveDescription::time_constant_s>{}},
    {"drive.moving_mass_kg", kAboveZero, Drive<&TrackDriveDescription::moving_mass_kg>{}},
    {"drive.encoder_counts_per_radian", kAboveZero, Drive<&TrackDriveDescription::encoder_counts_per_radian>{}},
    {"drive.amperes_per_newton", kZeroOrMore, Drive<&TrackDriveDescription::amperes_per_newton>{}},
    {"drive.idle_amperes", kZeroOrMore, Drive<&TrackDriveDescription::idle_amperes>{}},
    {"battery.open_circuit_v", kAboveZero, Battery<&BatteryDescription::open_circuit_v>{}},
    {"battery.internal_resistance_ohm", kZeroOrMore, Battery<&BatteryDescription::internal_resistance_ohm>{}},
};

constexpr PlainNumber kOfTracks[] = {
    {"track.length_m", kAboveZero, Track<&TrackDescription::length_m>{}},
    {"track.end_radius_m", kAboveZero, Track<&TrackDescription::end_radius_m>{}},
    {"track.width_m", kAboveZero, Track<&TrackDescription::width_m>{}},
    {"track.left_center_m[0]", kAnyNumber, Track<&TrackDescription::p_BT_m, 0>{}},
    {"track.left_center_m[1]", kAboveZero, Track<&TrackDescription::p_BT_m, 1>{}},
    {"track.left_center_m[2]", kAnyNumber, Track<&TrackDescription::p_BT_m, 2>{}},
    {"track.friction_along", kFrictionRange, Track<&TrackDescription::friction_along>{}},
    {"track.friction_across", kFrictionRange, Track<&TrackDescription::friction_across>{}},
    {"track.lug_height_m", kLugRange, Track<&TrackDescription::lug_height_m>{}},
    {"track.shear_deformation_m", kShearRange, Track<&TrackDescription::shear_deformation_m>{}},
};

constexpr PlainNumber kOfFlippers[] = {
    {"flipper.mass_kg", kAboveZero, Flipper<&FlipperDescription::mass_kg>{}},
    {"flipper.length_m", kAboveZero, Flipper<&FlipperDescription::length_m>{}},
    {"flipper.pivot_radius_m", kAboveZero, Flipper<&FlipperDescription::pivot_radius_m>{}},
    {"flipper.tip_radius_m", kAboveZero, Flipper<&FlipperDescription::tip_radius_m>{}},
    {"flipper.width_m", kAboveZero, Flipper<&FlipperDescription::width_m>{}},
    {"flipper.front_left_pivot_m[0]", kAboveZero, Flipper<&FlipperDescription::p_BPivot_m, 0>{}},
    {"flipper.front_left_pivot_m[1]", kAboveZero, Flipper<&FlipperDescription::p_BPivot_m, 1>{}},
    {"flipper.front_left_pivot_m[2]", kAnyNumber, Flipper<&FlipperDescription::p_BPivot_m, 2>{}},
    {"flipper.friction_along", kFrictionRange, Flipper<&FlipperDescription::friction_along>{}},
    {"flipper.friction_across", kFrictionRange, Flipper<&FlipperDescription::friction_across>{}},
    {"flipper.min_angle_rad", kMinAngleRange, Flipper<&FlipperDescription::min_angle_rad>{}},
    {"flipper.max_angle_rad", kMaxAngleRange, Flipper<&FlipperDescription::max_angle_rad>{}},
    {"servo.max_speed_radps", kAboveZero, Servo<&FlipperServoDescription::max_speed_radps>{}},
    {"servo.max_torque_nm", kAboveZero, Servo<&FlipperServoDescription::max_torque_nm>{}},
    {"servo.amperes_per_nm", kZeroOrMore, Servo<&FlipperServoDescription::amperes_per_nm>{}},
};

RobotNumber number_of(const PlainNumber& plain) {
  return {std::string(plain.key), {std::string(plain.key)}, plain.range, plain.read, plain.write};
}

double contact_length_m(const RobotDescription& robot) {
  return robot.contact_length_m();
}

void add_derived(std::vector<RobotNumber>& numbers) {
  numbers.push_back({"track.separation_m",
                     {"track.left_center_m[1]"},
                     kAboveZero,
                     [](const RobotDescription& robot) { return robot.track_gauge_m(); },
                     [](RobotDescription& robot, double value) { robot.track.front().p_BT_m.y() = value / 2; }});
  numbers.push_back({"track.contact_length_m",
                     {"track.length_m"},
                     kAboveZero,
                     contact_length_m,
                     [](RobotDescription& robot, double value) {
                       // subtracting and adding again does not always restore the same bits
                       if (value != contact_length_m(robot))
                         robot.track.front().length_m = value + 2 * robot.track.front().end_radius_m;
                     }});
}

void add_sensors(const RobotDescription& described, std::vector<RobotNumber>& numbers) {
  for (const physics::SensorDescription& sensor : described.sensors) {
    const std::string key = fmt::format("sensor[{}].delay_s", sensor.name);
    // by its name: a simulated robot may have fewer sensors than the described one
    const auto find = [name = sensor.name](auto& robot) {
      return std::ranges::find(robot.sensors, name, &physics::SensorDescription::name);
    };
    numbers.push_back({key,
                       {key},
                       kDelayRange,
                       [find](const RobotDescription& robot) {
                         const auto found = find(robot);
                         return found == robot.sensors.end() ? 0 : found->delay_s;
                       },
                       [find](RobotDescription& robot, double value) {
                         const auto found = find(robot);
                         if (found != robot.sensors.end()) found->delay_s = value;
                       }});
  }
}

void add_effects(std::vector<RobotNumber>& numbers) {
  for (const physics::EffectInfo& effect : physics::effect_catalogue()) {
    if (effect.name == "command_loss") continue;
    for (const physics::EffectParameter& parameter : effect.parameters) {
      const std::string key = fmt::format("effects.{}.{}", effect.name, parameter.name);
      numbers.push_back({key,
                         {key},
                         {.min = parameter.min, .max = parameter.max},
                         [at = parameter.value](const RobotDescription& robot) { return robot.effects.*at; },
                         [at = parameter.value](RobotDescription& robot, double value) { robot.effects.*at = value; }});
    }
  }
}

std::string why_out_of_range(const RobotNumber& number, const RobotDescription& robot) {
  const double value = number.get(robot);
  const bool inside = number.range.open_min ? value > number.range.min : value >= number.range.min;
  if (std::isfinite(value) && inside && value <= number.range.max) return {};
  const std::string is = fmt::format("{} is {}, but must be", number.key, value);
  if (!std::isfinite(value)) return is + " finite";
  if (std::isinf(number.range.max))
    return fmt::format("{} {} {}", is, number.range.open_min ? "more than" : "at least", number.range.min);
  return fmt::format("{} from {} to {}", is, number.range.min, number.range.max);
}

}  // namespace

std::vector<RobotNumber> robot_numbers(const RobotDescription& robot) {
  std::vector<RobotNumber> numbers;
  for (const PlainNumber& plain : kOfEveryRobot) numbers.push_back(number_of(plain));
  if (robot.has_flippers())
    for (const PlainNumber& plain : kOfFlippers) numbers.push_back(number_of(plain));
  if (!robot.has_wheels()) {
    for (const PlainNumber& plain : kOfTracks) numbers.push_back(number_of(plain));
    add_derived(numbers);
  }
  for (RobotNumber& number : wheel_numbers(robot)) numbers.push_back(std::move(number));
  add_sensors(robot, numbers);
  add_effects(numbers);
  return numbers;
}

std::optional<RobotNumber> find_robot_number(const RobotDescription& robot, std::string_view key) {
  std::vector<RobotNumber> numbers = robot_numbers(robot);
  const auto found = std::ranges::find(numbers, key, &RobotNumber::key);
  if (found == numbers.end()) return std::nullopt;
  return std::move(*found);
}

std::string why_impossible(const RobotDescription& robot) {
  for (const RobotNumber& number : robot_numbers(robot))
    if (std::string why = why_out_of_range(number, robot); !why.empty()) return why;
  const Eigen::Vector3d& I = robot.body.inertia_kgm2;
  if (2 * I.maxCoeff() > I.sum() * (1 + 1e-9))
    return "body.inertia_kgm2 has a moment that is larger than the sum of the two others";
  if (std::string why = why_impossible_wheels(robot); !why.empty() || robot.has_wheels()) return why;
  const TrackDescription& track = robot.track.front();
  if (track.length_m <= 2 * track.end_radius_m)
    return fmt::format("track.length_m is {}, but must be more than twice track.end_radius_m", track.length_m);
  if (track.p_BT_m.y() <= track.width_m / 2)
    return fmt::format("track.separation_m is {}, but must be more than track.width_m", robot.track_gauge_m());
  if (!robot.has_flippers()) return {};
  const FlipperDescription& flipper = robot.flipper.front();
  if (flipper.length_m <= std::abs(flipper.pivot_radius_m - flipper.tip_radius_m))
    return fmt::format(
        "flipper.length_m is {}, but must be more than the difference of flipper.pivot_radius_m and "
        "flipper.tip_radius_m",
        flipper.length_m);
  if (flipper.start_angle_rad < flipper.min_angle_rad || flipper.start_angle_rad > flipper.max_angle_rad)
    return "flipper.start_angle_rad is not between flipper.min_angle_rad and flipper.max_angle_rad";
  return {};
}

}  // namespace kenaf::gap::candidates
