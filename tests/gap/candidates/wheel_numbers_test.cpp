// Numbers of robots on wheels: found, moved together, and written back.
#include <catch2/catch.hpp>
#include <string>

#include "gap/candidates/candidate.hpp"
#include "gap/candidates/robot_numbers.hpp"
#include "gap/candidates/wheel_numbers.hpp"
#include "gap/candidates/write_candidates.hpp"
#include "tests/gap/candidates/robots.hpp"

namespace kenaf::gap::candidates {
namespace {

using physics::RobotDescription;
using Values = std::vector<std::pair<Candidate, double>>;

// Kenaf's file with three pairs of wheels and a caster in place of tracks and flippers. Axles at 0.3, 0.1 and -0.3 m;
// 0.5, 0.6 and 0.5 m from side to side; the middle wheels grip half as well across.
std::string wheeled_text() {
  std::string text = test::robot_text("kenaf");
  for (const char* table : {"[track]", "[flipper]", "[servo]"}) {
    const std::size_t from = text.find(table);
    text.erase(from, text.find("\n[", from) + 1 - from);
  }
  const auto wheel = [](const std::string& at, const std::string& across) {
    return "[[wheel]]  # öffentlich\nleft_center_m = [" + at + "]\nradius_m = 0.1\nwidth_m = 0.04  # chosen\n" +
           "friction_along = 0.8\nfriction_across = " + across + "\n\n";
  };
  return text + "\n" + wheel("0.3, 0.25, -0.02", "0.6") + wheel("0.1, 0.3, -0.02", "0.3") +
         wheel("-0.3, 0.25, -0.02", "0.6") +
         "[[caster]]\ncenter_m = [-0.5, 0.0, -0.08]\nradius_m = 0.04\nwidth_m = 0.02\nfriction = 0.05\n";
}

RobotDescription wheeled() {
  return physics::parse_robot(wheeled_text(), "robot.toml");
}

RobotDescription with_number(RobotDescription robot, const std::string& key, double value) {
  const std::optional<RobotNumber> number = find_robot_number(robot, key);
  REQUIRE(number);
  number->set(robot, value);
  return robot;
}

}  // namespace

TEST_CASE("A robot on wheels has numbers of wheels in place of those of tracks") {
  const RobotDescription robot = wheeled();
  CHECK_FALSE(find_robot_number(robot, "track.length_m"));
  CHECK_FALSE(find_robot_number(robot, "track.separation_m"));
  CHECK_FALSE(find_robot_number(test::robot_of("kenaf"), "wheel.radius_m"));
  CHECK(wheel_numbers(test::robot_of("kenaf")).empty());
  CHECK(find_robot_number(robot, "wheel[1].friction_across")->get(robot) == 0.3);
  CHECK(find_robot_number(robot, "wheel[2].left_center_m[0]")->get(robot) == -0.3);
  // gauges of 0.5, 0.6 and 0.5 m
  CHECK(find_robot_number(robot, "wheel.separation_m")->get(robot) == Approx(1.6 / 3));
  CHECK(find_robot_number(robot, "wheel.base_m")->get(robot) == Approx(0.6));
  CHECK(find_robot_number(robot, "caster.friction")->get(robot) == 0.05);
  CHECK(why_impossible(robot).empty());
}

TEST_CASE("A number of all wheels keeps their differences") {
  const RobotDescription robot = wheeled();
  // twice the front pair's friction: twice that of all
  const RobotDescription grippy = with_number(robot, "wheel.friction_across", 1.2);
  CHECK(grippy.track[1].friction_across == Approx(0.6));
  CHECK(grippy.track[2].friction_across == Approx(1.2));
  // 0.02 m more from side to side: 0.01 m further out each
  const RobotDescription wider = with_number(robot, "wheel.separation_m", 1.6 / 3 + 0.02);
  CHECK(wider.track[0].p_BT_m.y() == Approx(0.26));
  CHECK(wider.track[1].p_BT_m.y() == Approx(0.31));
  // axles 0.9 m apart about their middle at x = 0: all x are 1.5 times as large
  const RobotDescription longer = with_number(robot, "wheel.base_m", 0.9);
  CHECK(longer.track[0].p_BT_m.x() == Approx(0.45));
  CHECK(longer.track[1].p_BT_m.x() == Approx(0.15));
  CHECK(longer.track[2].p_BT_m.x() == Approx(-0.45));
  // a wheel's length is twice its radius, whatever the radius: it stays a wheel
  const RobotDescription larger = with_number(robot, "wheel.radius_m", 0.137);
  for (const auto& wheel : larger.track) CHECK(wheel.length_m == 2 * wheel.end_radius_m);
  CHECK(larger.has_wheels());
  CHECK(larger.ride_height_m() == Approx(0.157));
}

TEST_CASE("Setting a number of wheels to what it is changes no bit") {
  const RobotDescription robot = wheeled();
  for (const RobotNumber& number : wheel_numbers(robot)) {
    RobotDescription same = robot;
    number.set(same, number.get(robot));
    INFO(number.key);
    CHECK(test::same_bits(same, robot));
  }
}

TEST_CASE("Wheels in each other's place, or through the middle, are impossible") {
  const RobotDescription robot = wheeled();
  CHECK(why_impossible(with_number(robot, "wheel[1].left_center_m[0]", 0.3))
            .find("wheel[1].left_center_m[0] is 0.3, but must be less than wheel[0].left_center_m[0]") == 0);
  CHECK(why_impossible(with_number(robot, "wheel[0].width_m", 0.6)).find("wheel[0].left_center_m[1] is 0.25, but") ==
        0);
  CHECK(why_impossible(with_number(robot, "wheel.radius_m", 0)).find("wheel[0].radius_m is 0, but") == 0);
}

TEST_CASE("A robot on wheels has candidates of wheels, and writes them for every pair") {
  const std::string text = wheeled_text();
  const RobotDescription robot = wheeled();
  const std::vector<Candidate> candidates = description_candidates(robot);
  CHECK(test::find_candidate(candidates, "track.width_m") == nullptr);
  const Candidate* across = test::find_candidate(candidates, "wheel.friction_across");
  const Candidate* separation = test::find_candidate(candidates, "wheel.separation_m");
  REQUIRE(across);
  REQUIRE(separation);
  CHECK(across->same_as == "friction_across");
  CHECK(separation->keys.size() == 3);
  // no pair may come through the middle: at least half way from the gauge to the width
  CHECK(separation->min >= (1.6 / 3 + 0.04) / 2);

  const std::string changed = robot_toml_with(text, Values{{*across, 0.3}, {*separation, 1.6 / 3 + 0.02}});
  const RobotDescription read = physics::parse_robot(changed, "robot.toml");
  CHECK(read.track[0].friction_across == Approx(0.3));
  CHECK(read.track[1].friction_across == Approx(0.15));
  CHECK(read.track[1].p_BT_m.y() == Approx(0.31));
  CHECK(changed.find("# öffentlich") != std::string::npos);
  CHECK(changed.find("width_m = 0.04  # chosen") != std::string::npos);
}

TEST_CASE("Both ends of each range make a possible robot, however the pairs of wheels differ") {
  // the rear wheels are closer together and wider, which the common numbers must leave possible, and grip as well as
  // anything may
  std::string text = wheeled_text();
  const std::size_t rear = text.find("-0.3, 0.25");
  text.replace(rear, 10, "-0.3, 0.10");
  text.replace(text.find("width_m = 0.04", rear), 14, "width_m = 0.16");
  text.replace(text.find("friction_along = 0.8", rear), 20, "friction_along = 9.0");
  const RobotDescription robot = physics::parse_robot(text, "robot.toml");
  bool any_separation = false;
  for (const Candidate& candidate : description_candidates(robot))
    for (const double end : {candidate.min, candidate.max}) {
      RobotDescription moved = robot;
      candidate.set(moved, end);
      INFO(candidate.name << " = " << end);
      CHECK(why_impossible(moved).empty());
      any_separation |= candidate.name == "wheel.separation_m" && end < candidate.present;
    }
  CHECK(any_separation);
}

}  // namespace kenaf::gap::candidates
