#include "gap/candidates/wheel_numbers.hpp"

#include <fmt/format.h>

#include <array>
#include <functional>

#include "gap/candidates/number_ranges.hpp"

namespace kenaf::gap::candidates {
namespace {

using physics::CasterDescription;
using physics::RobotDescription;
using physics::TrackDescription;

double radius_m(const TrackDescription& wheel) {
  return wheel.end_radius_m;
}
void set_radius(TrackDescription& wheel, double value_m) {
  wheel.end_radius_m = value_m;
  wheel.length_m = 2 * value_m;
}

// A number of one pair; without an index it is that of all pairs.
struct WheelNumber {
  std::string_view key;
  NumberRange range;
  double (*read)(const TrackDescription&);
  void (*write)(TrackDescription&, double);
};

template <auto member>
constexpr WheelNumber plain(std::string_view key, NumberRange range) {
  return {key, range, [](const TrackDescription& wheel) { return wheel.*member; },
          [](TrackDescription& wheel, double value) { wheel.*member = value; }};
}
template <int axis>
constexpr WheelNumber of_center(std::string_view key, NumberRange range) {
  return {key, range, [](const TrackDescription& wheel) { return wheel.p_BT_m[axis]; },
          [](TrackDescription& wheel, double value) { wheel.p_BT_m[axis] = value; }};
}

// Alike on all wheels of most robots.
constexpr std::array kOfTheWheel{
    WheelNumber{"radius_m", kAboveZero, radius_m, set_radius},
    plain<&TrackDescription::width_m>("width_m", kAboveZero),
    plain<&TrackDescription::friction_along>("friction_along", kFrictionRange),
    plain<&TrackDescription::friction_across>("friction_across", kFrictionRange),
};
constexpr std::array kOfItsPlace{
    of_center<0>("left_center_m[0]", kAnyNumber),
    of_center<1>("left_center_m[1]", kAboveZero),
    of_center<2>("left_center_m[2]", kAnyNumber),
};

std::string key_of_pair(std::size_t pair, std::string_view key) {
  return fmt::format("wheel[{}].{}", pair, key);
}

std::vector<std::string> keys_of_all(const RobotDescription& robot, std::string_view key) {
  std::vector<std::string> keys;
  for (std::size_t i = 0; i < robot.track.size(); ++i) keys.push_back(key_of_pair(i, key));
  return keys;
}

RobotNumber of_pair(std::size_t pair, const WheelNumber& number) {
  const std::string key = key_of_pair(pair, number.key);
  return {key,
          {key},
          number.range,
          [pair, read = number.read](const RobotDescription& robot) { return read(robot.track[pair]); },
          [pair, write = number.write](RobotDescription& robot, double value) { write(robot.track[pair], value); }};
}

// Differences between the pairs stay as ratios; if the front pair's number is 0, all become alike.
RobotNumber of_all(const RobotDescription& robot, const WheelNumber& number) {
  return {fmt::format("wheel.{}", number.key), keys_of_all(robot, number.key), number.range,
          [read = number.read](const RobotDescription& r) { return read(r.track.front()); },
          [read = number.read, write = number.write](RobotDescription& r, double value) {
            const double before = read(r.track.front());
            if (value == before) return;
            for (TrackDescription& wheel : r.track) write(wheel, before != 0 ? value * (read(wheel) / before) : value);
          }};
}

double middle_m(const RobotDescription& robot) {
  return (robot.track.front().p_BT_m.x() + robot.track.back().p_BT_m.x()) / 2;
}

double base_m(const RobotDescription& robot) {
  return robot.track.front().p_BT_m.x() - robot.track.back().p_BT_m.x();
}

// A length that moves the wheels along one axis of B; `move` gets the robot and the change.
RobotNumber of_places(const RobotDescription& robot, std::string_view key, int axis, NumberRange range,
                      double (*read)(const RobotDescription&), void (*move)(RobotDescription&, double change)) {
  return {fmt::format("wheel.{}", key), keys_of_all(robot, fmt::format("left_center_m[{}]", axis)), range, read,
          [read, move](RobotDescription& r, double value) {
            if (const double before = read(r); value != before) move(r, value - before);
          }};
}

void add_places(const RobotDescription& robot, std::vector<RobotNumber>& numbers) {
  numbers.push_back(of_places(
      robot, "separation_m", 1, kAboveZero, [](const RobotDescription& r) { return r.track_gauge_m(); },
      [](RobotDescription& r, double change) {
        for (TrackDescription& wheel : r.track) wheel.p_BT_m.y() += change / 2;
      }));
  numbers.push_back(of_places(robot, "forward_m", 0, kAnyNumber, middle_m, [](RobotDescription& r, double change) {
    for (TrackDescription& wheel : r.track) wheel.p_BT_m.x() += change;
  }));
  numbers.push_back(of_places(
      robot, "up_m", 2, kAnyNumber, [](const RobotDescription& r) { return r.track.front().p_BT_m.z(); },
      [](RobotDescription& r, double change) {
        for (TrackDescription& wheel : r.track) wheel.p_BT_m.z() += change;
      }));
  if (robot.track.size() == 1) return;
  numbers.push_back(of_places(robot, "base_m", 0, kAboveZero, base_m, [](RobotDescription& r, double change) {
    const double middle = middle_m(r), stretch = change / base_m(r);
    for (TrackDescription& wheel : r.track) wheel.p_BT_m.x() += stretch * (wheel.p_BT_m.x() - middle);
  }));
}

void add_casters(const RobotDescription& robot, std::vector<RobotNumber>& numbers) {
  if (robot.caster.empty()) return;
  std::vector<std::string> keys;
  for (std::size_t i = 0; i < robot.caster.size(); ++i) {
    keys.push_back(fmt::format("caster[{}].friction", i));
    numbers.push_back({keys.back(),
                       {keys.back()},
                       kFrictionRange,
                       [i](const RobotDescription& r) { return r.caster[i].friction; },
                       [i](RobotDescription& r, double value) { r.caster[i].friction = value; }});
  }
  numbers.push_back({"caster.friction", keys, kFrictionRange,
                     [](const RobotDescription& r) { return r.caster.front().friction; },
                     [](RobotDescription& r, double value) {
                       const double before = r.caster.front().friction;
                       if (value == before) return;
                       for (CasterDescription& caster : r.caster)
                         caster.friction = before != 0 ? value * (caster.friction / before) : value;
                     }});
}

}  // namespace

std::vector<RobotNumber> wheel_numbers(const RobotDescription& robot) {
  std::vector<RobotNumber> numbers;
  if (!robot.has_wheels()) return numbers;
  for (std::size_t i = 0; i < robot.track.size(); ++i) {
    for (const WheelNumber& number : kOfTheWheel) numbers.push_back(of_pair(i, number));
    for (const WheelNumber& number : kOfItsPlace) numbers.push_back(of_pair(i, number));
  }
  for (const WheelNumber& number : kOfTheWheel) numbers.push_back(of_all(robot, number));
  add_places(robot, numbers);
  add_casters(robot, numbers);
  return numbers;
}

std::string why_impossible_wheels(const RobotDescription& robot) {
  if (!robot.has_wheels()) return {};
  for (std::size_t i = 0; i < robot.track.size(); ++i) {
    const TrackDescription& wheel = robot.track[i];
    if (wheel.p_BT_m.y() <= wheel.width_m / 2)
      return fmt::format("{} is {}, but must be more than half of {}", key_of_pair(i, "left_center_m[1]"),
                         wheel.p_BT_m.y(), key_of_pair(i, "width_m"));
    if (i > 0 && wheel.p_BT_m.x() >= robot.track[i - 1].p_BT_m.x())
      return fmt::format("{} is {}, but must be less than {}", key_of_pair(i, "left_center_m[0]"), wheel.p_BT_m.x(),
                         key_of_pair(i - 1, "left_center_m[0]"));
  }
  return {};
}

}  // namespace kenaf::gap::candidates
