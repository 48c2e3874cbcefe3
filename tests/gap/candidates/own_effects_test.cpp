// Effects of one's own: what their file says is what moves, and what is wrong in it is said with its place.
#include <catch2/catch.hpp>
#include <fstream>

#include "gap/candidates/own_effects.hpp"
#include "tests/gap/candidates/robots.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::candidates;
using physics::RobotDescription;

namespace {

// That of docs/effects.md.
const std::string kLoad = R"([[effect]]
name = "load_behind"
summary = "a load on the deck, 0.2 m behind the body's centre of mass"
stage = "body"
parameter = "mass_kg"
unit = "kg"
neutral = 0.0
min = 0.0
max = 2.0

[[effect.moves]]
key = "body.mass_kg"
add = 1.0

[[effect.moves]]
key = "body.center_of_mass_m[0]"
add = -0.0133

[[effect.moves]]
key = "body.inertia_kgm2[1]"
add = 0.04

[[effect.moves]]
key = "body.inertia_kgm2[2]"
add = 0.04
)";

std::vector<Candidate> parsed(const std::string& text) {
  return parse_own_effects(text, "own.toml", test::robot_of("kenaf"));
}

// The error of kLoad with `from` replaced.
std::string error_with(const std::string& from, const std::string& to) {
  std::string text = kLoad;
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  text.replace(at, from.size(), to);
  try {
    parsed(text);
  } catch (const description::DescriptionError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("The worked example of the documentation is what is tested here") {
  CHECK(test::read_file(std::string(KENAF_SOURCE_DIR) + "/docs/effects.md").find(kLoad) != std::string::npos);
}

TEST_CASE("An effect of one's own moves its numbers together") {
  const RobotDescription robot = test::robot_of("kenaf");
  const std::vector<Candidate> own = parsed(kLoad);
  REQUIRE(own.size() == 1);
  const Candidate& load = own.front();
  CHECK(load.name == "load_behind");
  CHECK(load.effect == "load_behind");
  CHECK(load.parameter == "mass_kg");
  CHECK(load.unit == "kg");
  CHECK(load.stage == physics::Stage::body);
  CHECK_FALSE(load.is_number_of_description);
  CHECK((load.min == 0 && load.neutral == 0 && load.present == 0 && load.max == 2));
  CHECK(load.keys.size() == 4);
  CHECK(test::same_bits(test::with(robot, load, 0), robot));
  // 1.5 kg more, 1.5 * 13.3 mm further back, 1.5 * 0.04 kg m^2 more
  const RobotDescription loaded = test::with(robot, load, 1.5);
  CHECK(loaded.body.mass_kg == Approx(16.5));
  CHECK(loaded.body.p_BBcm_m.x() == Approx(-0.01995));
  CHECK(loaded.body.inertia_kgm2.y() == Approx(0.50));
  CHECK(loaded.body.inertia_kgm2.z() == Approx(0.58));
}

TEST_CASE("Scaled numbers are multiplied, and those of the catalogue's effects may be moved, too") {
  // a sprocket that is larger by a tenth: tracks run 1.1 times as fast, and report 0.9 of what they run
  const std::vector<Candidate> own = parsed(R"(
[[effect]]
name = "larger_sprocket"
summary = "sprockets of another radius than the drives and encoders are set up for"
stage = "drive"
parameter = "scale"
unit = "1"
neutral = 1.0
min = 0.85
max = 1.15
moves = [
  { key = "effects.command_gain.gain", scale = 1.0 },
  { key = "effects.encoder_scale.scale", scale = -1.0 },
]
)");
  RobotDescription robot = test::robot_of("kenaf");
  robot.effects.command_gain = 0.8;  // as another candidate has set it
  own.front().set(robot, 1.1);
  CHECK(robot.effects.command_gain == Approx(0.88));
  CHECK(robot.effects.encoder_scale == Approx(0.9));
}

TEST_CASE("What is wrong in a file of own effects is said with file, line and column") {
  using Catch::StartsWith;
  CHECK_THAT(error_with("name = \"load_behind\"\n", ""), StartsWith("own.toml:1:1: effect[0].name is missing"));
  CHECK_THAT(error_with("load_behind", "load behind"), StartsWith("own.toml:2:8: effect[0].name must consist of"));
  CHECK_THAT(error_with("load_behind", "mass"),
             StartsWith("own.toml:2:8: effect[0].name is already the name of an effect"));
  CHECK_THAT(error_with("\"body\"", "\"wheels\""),
             StartsWith("own.toml:4:9: effect[0].stage is \"wheels\", but must be one of command, drive, body"));
  CHECK_THAT(error_with("\"kg\"", "\"\""), StartsWith("own.toml:6:8: effect[0].unit must be one line"));
  CHECK_THAT(error_with("unit", "unti"), StartsWith("own.toml:1:1: effect[0].unit is missing"));
  CHECK_THAT(error_with("neutral = 0.0", "neutral = 0.0\nmin_kg = 1"),
             StartsWith("own.toml:8:1: effect[0].min_kg is not a known key"));
  CHECK_THAT(error_with("min = 0.0", "min = 0.5"), StartsWith("own.toml:8:7: effect[0].min must not be more than"));
  CHECK_THAT(error_with("max = 2.0", "max = -1"), StartsWith("own.toml:9:7: effect[0].max must not be less than"));
  CHECK_THAT(error_with("max = 2.0", "max = 0.0"), StartsWith("own.toml:9:7: effect[0].max must be more than min"));
  CHECK_THAT(error_with("max = 2.0", "max = nan"), StartsWith("own.toml:9:7: effect[0].max is nan"));
  CHECK_THAT(
      error_with("body.mass_kg", "body.weight_kg"),
      StartsWith("own.toml:12:7: effect[0].moves[0].key is \"body.weight_kg\", which is not a number of this robot: "
                 "it has body.mass_kg, body.size_m[0]"));
  CHECK_THAT(error_with("body.mass_kg", "boby.mass_kg"),
             Catch::Contains("its tables with numbers are battery, body, drive"));
  CHECK_THAT(error_with("add = 1.0", "by = 1.0"), StartsWith("own.toml:12:7: effect[0].moves[0].key needs"));
  CHECK_THAT(error_with("add = 1.0", "add = 1.0\nscale = 1.0"),
             StartsWith("own.toml:12:7: effect[0].moves[0].key needs either add or scale in the same table"));
  CHECK_THAT(error_with("add = 1.0", "add = 0"), StartsWith("own.toml:13:7: effect[0].moves[0].add is 0"));
  CHECK_THAT(error_with("inertia_kgm2[2]", "inertia_kgm2[1]"),
             StartsWith("own.toml:24:7: effect[0].moves[3].key is already changed by this effect"));
  // one number by two of its names
  CHECK_THAT(error_with("body.mass_kg\"\nadd = 1.0\n\n[[effect.moves]]\nkey = \"body.center_of_mass_m[0]\"",
                        "track.separation_m\"\nadd = 1.0\n\n[[effect.moves]]\nkey = \"track.left_center_m[1]\""),
             StartsWith("own.toml:16:7: effect[0].moves[1].key is already changed by this effect"));
  CHECK_THAT(error_with("[[effect]]", "[[effects]]"), Catch::Contains("own.toml"));
  CHECK_THAT(error_with("max = 2.0", "max = "), StartsWith("own.toml:9:"));
}

TEST_CASE("A range at an end of which there is no such robot is refused") {
  // 15 kg less 15 kg
  CHECK(error_with("min = 0.0", "min = -15.0")
            .starts_with("own.toml:8:7: effect[0].min is -15, which makes an invalid robot: body.mass_kg is 0, "
                         "but must be more than 0"));
  // about y 0.44 + 4 * 0.04 and about z 0.52 + 4 * 0.04 stay together; alone, 0.52 + 0.16 is more than 0.13 + 0.44
  CHECK(error_with("max = 2.0", "max = 4.0").empty());
  CHECK_THAT(error_with("[[effect.moves]]\nkey = \"body.inertia_kgm2[1]\"\nadd = 0.04\n\n", ""),
             Catch::Contains("body.inertia_kgm2"));
}

TEST_CASE("Own effects have names of their own, and a file has one at least") {
  const std::string of_second = "own.toml:" + std::to_string(1 + std::ranges::count(kLoad, '\n') + 1) + ":8: ";
  CHECK_THROWS_WITH(parsed(kLoad + kLoad), of_second + "effect[1].name is also the name of another effect");
  CHECK_THROWS_WITH(parsed(""), Catch::Contains("own.toml:") && Catch::Contains("effect is missing"));
  CHECK_THROWS_WITH(parsed("[[effect]]\nname = \"a\"\n"), Catch::StartsWith("own.toml:1:1: "));
}

TEST_CASE("A robot without flippers has no numbers of theirs") {
  std::string text = kLoad;
  text.replace(text.find("body.mass_kg"), 12, "flipper.mass_kg");
  CHECK_NOTHROW(parse_own_effects(text, "own.toml", test::robot_of("kenaf")));
  CHECK_THROWS_WITH(parse_own_effects(text, "own.toml", test::robot_of("marmotte")),
                    Catch::Contains("flipper.mass_kg\", which is not a number of this robot"));
}

TEST_CASE("A file of own effects is read by its path") {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "own.toml") << kLoad;
  CHECK(read_own_effects(folder / "own.toml", test::robot_of("kenaf")).size() == 1);
  CHECK_THROWS_WITH(read_own_effects(folder / "none.toml", test::robot_of("kenaf")),
                    Catch::Contains("none.toml: cannot be read"));
  CHECK_THROWS_WITH(read_own_effects("kenaf", test::robot_of("kenaf")), Catch::Contains("kenaf: cannot be read"));
}
