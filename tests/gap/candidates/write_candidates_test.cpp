// A robot's file with values set in it reads as the robot that they make.
#include <catch2/catch.hpp>
#include <utility>

#include "gap/candidates/own_effects.hpp"
#include "gap/candidates/write_candidates.hpp"
#include "tests/gap/candidates/robots.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::candidates;
using physics::RobotDescription;
using test::find_candidate;
using Values = std::vector<std::pair<Candidate, double>>;

namespace {

std::ptrdiff_t comments_of(const std::string& text) {
  return std::ranges::count(text, '#');
}

// The line of `text` that begins with `key`; empty: there is none.
std::string line_of(const std::string& text, const std::string& key) {
  const std::size_t at = text.find("\n" + key);
  return at == text.npos ? "" : text.substr(at + 1, text.find('\n', at + 1) - at - 1);
}

// The file of a shipped robot with one candidate at `value`.
std::string written_with(const std::string& robot, const std::string& candidate, double value) {
  const std::string text = test::robot_text(robot);
  const std::vector<Candidate> candidates = test::all_candidates(physics::parse_robot(text, "a.toml"));
  const Candidate* found = find_candidate(candidates, candidate);
  REQUIRE(found);
  return robot_toml_with(text, Values{{*found, value}});
}

}  // namespace

TEST_CASE("Every candidate's value, written and read, gives the robot that it makes, bit for bit") {
  for (const char* name : {"kenaf", "marmotte"}) {
    const std::string text = test::robot_text(name);
    const RobotDescription robot = physics::parse_robot(text, "robot.toml");
    for (const Candidate& candidate : test::all_candidates(robot))
      for (const double value : {candidate.min, candidate.max, candidate.present + (candidate.max - candidate.min) / 70,
                                 candidate.present - (candidate.max - candidate.min) / 30}) {
        if (value < candidate.min || value > candidate.max) continue;
        CAPTURE(name, candidate.name, value);
        const std::string changed = robot_toml_with(text, Values{{candidate, value}});
        CHECK(test::same_bits(physics::parse_robot(changed, "robot.toml"), test::with(robot, candidate, value)));
        CHECK(comments_of(changed) >= comments_of(text));
      }
  }
}

TEST_CASE("All candidates of the catalogue at once are written, too") {
  const std::string text = test::robot_text("kenaf");
  RobotDescription robot = physics::parse_robot(text, "robot.toml");
  Values values;
  for (const Candidate& candidate : catalogue_candidates(robot, true)) values.emplace_back(candidate, candidate.max);
  for (const auto& [candidate, value] : values) candidate.set(robot, value);
  CHECK(test::same_bits(physics::parse_robot(robot_toml_with(text, values), "robot.toml"), robot));
}

TEST_CASE("What does not change the robot does not change a letter of its file") {
  const std::string text = test::robot_text("kenaf");
  Values values;
  for (const Candidate& candidate : test::all_candidates(physics::parse_robot(text, "robot.toml")))
    values.emplace_back(candidate, candidate.present);
  CHECK(robot_toml_with(text, values) == text);
  CHECK(robot_toml_with(text, {}) == text);
}

TEST_CASE("A number is replaced where it stands, alone or in a list, and its comment stays") {
  CHECK(line_of(written_with("kenaf", "drive.max_speed_mps", 0.45), "max_speed_mps") ==
        "max_speed_mps = 0.45                       # chosen");
  CHECK(line_of(written_with("kenaf", "body.mass_kg", 16), "mass_kg") ==
        "mass_kg = 16.0                            # chosen: the 20 kg less four flippers");
  // the tracks' planes: half of the separation to the left
  CHECK(line_of(written_with("kenaf", "track.separation_m", 0.25), "left_center_m") ==
        "left_center_m = [0.0, 0.125, -0.025]       # chosen: the belly is at z = -0.09, half the envelope's height");
  CHECK(line_of(written_with("kenaf", "body.inertia_kgm2[2]", 0.5), "inertia_kgm2")
            .starts_with("inertia_kgm2 = [0.13, 0.44, 0.5] "));
}

TEST_CASE("A key that was not there is added to its table, a sensor's to the sensor of that name") {
  const std::string with_lugs = written_with("marmotte", "track.lug_height_m", 0.002);
  CHECK(with_lugs.find("\n[track]\nlug_height_m = 0.002\n") != std::string::npos);
  const std::string late = written_with("marmotte", "sensor[IMU].delay_s", 0.04);
  CHECK(late.find("\n[[sensor]]\ndelay_s = 0.04\ntype = \"IMU\"\n") != std::string::npos);
}

TEST_CASE("An effect is added as a table, and one that is there is changed in place") {
  const std::string once = written_with("kenaf", "command_delay", 0.08);
  CHECK(once.starts_with(test::robot_text("kenaf")));
  CHECK(once.find("\n[effects.command_delay]") != std::string::npos);
  CHECK(line_of(once, "delay_s") == "delay_s = 0.08");
  const RobotDescription robot = physics::parse_robot(once, "robot.toml");
  const std::vector<Candidate> candidates = catalogue_candidates(robot, false);
  const std::string twice = robot_toml_with(once, Values{{*find_candidate(candidates, "command_delay"), 0.125}});
  CHECK(line_of(twice, "delay_s") == "delay_s = 0.125");
  CHECK(twice.size() == once.size() + 1);
}

TEST_CASE("Where nothing can be added, the file is written anew") {
  std::string text = test::robot_text("marmotte");
  const std::string at = "usarsim_class = \"USARBot.Marmotte\"\n";
  text.insert(text.find(at) + at.size(), "effects = { command_gain = { gain = 0.9 } }\n");
  const RobotDescription robot = physics::parse_robot(text, "robot.toml");
  const std::vector<Candidate> candidates = test::all_candidates(robot);
  const Candidate& delay = *find_candidate(candidates, "command_delay");
  const std::string changed = robot_toml_with(text, Values{{delay, 0.1}});
  CHECK(test::same_bits(physics::parse_robot(changed, "robot.toml"), test::with(robot, delay, 0.1)));
  // one that only moves a number in place keeps it
  const std::string gain = robot_toml_with(text, Values{{*find_candidate(candidates, "command_gain"), 1.1}});
  CHECK(gain.find("effects = { command_gain = { gain = 1.1 } }\n") != std::string::npos);
  CHECK(comments_of(gain) == comments_of(text));
}

TEST_CASE("Letters of more than one byte before a number do not move it, nor do DOS line ends") {
  std::string text = test::robot_text("marmotte");
  text.resize(text.find("[[sensor]]"));  // the last ones of the file
  const std::string at = "[body]\n";
  text.insert(text.find(at), "sensor = [{ type = \"INS\", name = \"Größe\", delay_s = 0.1 }]  # spät\r\n");
  const std::vector<Candidate> candidates = description_candidates(physics::parse_robot(text, "robot.toml"));
  const Candidate* delay = find_candidate(candidates, "sensor[Größe].delay_s");
  REQUIRE(delay);
  std::string expected = text;
  expected.replace(expected.find("delay_s = 0.1"), 13, "delay_s = 0.25");
  CHECK(robot_toml_with(text, Values{{*delay, 0.25}}) == expected);
}

TEST_CASE("An effect of one's own is written as the numbers that it moves") {
  const std::string text = test::robot_text("kenaf");
  const RobotDescription robot = physics::parse_robot(text, "robot.toml");
  const std::vector<Candidate> own = parse_own_effects(R"(
[[effect]]
name = "wider"
summary = "tracks further apart, on wider belts"
stage = "body"
parameter = "by_m"
unit = "m"
neutral = 0.0
min = -0.02
max = 0.1
[[effect.moves]]
key = "track.separation_m"
add = 1.0
[[effect.moves]]
key = "track.width_m"
scale = 2.0
)",
                                                       "own.toml", robot);
  const std::string changed = robot_toml_with(text, Values{{own.front(), 0.05}});
  // 0.2 m + 0.05 m apart, so 0.125 m to the left; 0.09 m times 1 + 2 * 0.05
  const RobotDescription read = physics::parse_robot(changed, "robot.toml");
  CHECK(read.track.front().p_BT_m.y() == Approx(0.125));
  CHECK(read.track.front().width_m == Approx(0.099));
  CHECK(test::same_bits(read, test::with(robot, own.front(), 0.05)));
  CHECK(comments_of(changed) == comments_of(text));
}

TEST_CASE("Values that make no robot together are refused, and so is a file that is none") {
  // moments of 0.95 about x and 0.39 about y need one of 0.56 about z at least, which has 0.52
  const std::string text = test::robot_text("kenaf");
  const std::vector<Candidate> candidates = description_candidates(physics::parse_robot(text, "robot.toml"));
  const Values values{{*find_candidate(candidates, "body.inertia_kgm2[0]"), 0.95},
                      {*find_candidate(candidates, "body.inertia_kgm2[1]"), 0.39}};
  CHECK_THROWS_WITH(robot_toml_with(text, values), Catch::Contains("no rigid body"));
  CHECK_THROWS_AS(robot_toml_with("no = robot", {}), description::DescriptionError);
}
