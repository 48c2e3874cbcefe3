// Manoeuvres as files: what ships, what is read, and what is refused where.
#include "rollout/manoeuvre.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "formats/description/data_files.hpp"
#include "physics/robot_description.hpp"
#include "tests/formats/runs/temporary_folder.hpp"

using namespace kenaf;
using namespace kenaf::rollout;
using Catch::Contains;

namespace {

const std::string kTwo = R"(
[[phase]]
name = "go"
track_mps = [0.1, 0.2]
flipper_rad = [0.1, 0.2, 0.3, 0.4]
at_most_s = 2.5
turned_rad = 1.5

[[manoeuvre]]
name = "first"
summary = "one"
world = "flat"
success = { x_above_m = 1.0, upright_within_rad = 0.2 }

[[manoeuvre]]
name = "second"
summary = "two"
world = "hall.sdf"
start_lift_m = 0.05
phase = [{ track_mps = [0.0, 0.0], at_most_s = 1.0 }, { track_mps = [-0.1, -0.1], at_most_s = 0.5, x_below_m = -1 }]
)";

// A manoeuvre of three phases, one of which may be given up.
std::string give_up_in_phase(int number, const std::string& what = "{ x_below_m = 0.5, pitch_below_rad = -0.3 }") {
  std::string text = "[[manoeuvre]]\nname = \"a\"\nsummary = \"\"\nworld = \"flat\"\n";
  for (int i = 0; i < 3; ++i)
    text += std::string("[[manoeuvre.phase]]\ntrack_mps = [0, 0]\nat_most_s = 1\n") +
            (i == number ? "give_up = " + what + "\n" : "");
  return text;
}

std::string error_of(const std::string& text) {
  try {
    parse_manoeuvres(text, "my.toml");
  } catch (const description::DescriptionError& error) {
    return error.what();
  }
  return "";
}

std::string error_with(const std::string& what, const std::string& instead) {
  std::string text = kTwo;
  const std::size_t found = text.find(what);
  REQUIRE(found != std::string::npos);
  return error_of(text.replace(found, what.size(), instead));
}

}  // namespace

TEST_CASE("Manoeuvres of a file share its phases, or have their own") {
  const auto all = parse_manoeuvres(kTwo, "sub/my.toml");
  REQUIRE(all.size() == 2);
  CHECK(all[0].name == "first");
  CHECK(all[0].world == "flat");
  REQUIRE(all[0].phases.size() == 1);
  CHECK(all[0].phases[0].name == "go");
  CHECK(all[0].phases[0].track_mps == std::array{0.1, 0.2});
  CHECK(*all[0].phases[0].flipper_rad == std::array{0.1, 0.2, 0.3, 0.4});
  CHECK(all[0].phases[0].end.turned_rad == 1.5);
  CHECK_FALSE(all[0].phases[0].end.x_above_m);
  CHECK(all[0].success->x_above_m == 1.0);
  CHECK(all[0].at_most_s() == 2.5);
  CHECK(all[1].world == "sub/hall.sdf");  // beside the manoeuvre
  CHECK(all[1].start_lift_m == 0.05);
  CHECK_FALSE(all[1].success);
  REQUIRE(all[1].phases.size() == 2);
  CHECK_FALSE(all[1].phases[0].flipper_rad);
  CHECK(all[1].at_most_s() == 1.5);
}

TEST_CASE("A phase that may be given up: any but the first and the last") {
  const auto phases = parse_manoeuvres(give_up_in_phase(1), "my.toml").front().phases;
  CHECK_FALSE(phases[0].give_up);
  REQUIRE(phases[1].give_up);
  CHECK(phases[1].give_up->x_below_m == 0.5);
  CHECK(phases[1].give_up->pitch_below_rad == -0.3);
  CHECK_FALSE(phases[2].give_up);
  CHECK_FALSE(
      parse_manoeuvres(give_up_in_phase(1, "{ x_below_m = 0.5 }"), "").front().phases[1].give_up->pitch_below_rad);

  CHECK_THAT(error_of(give_up_in_phase(0)),
             Contains("my.toml:8:11: manoeuvre[0].phase[0].give_up must not be in the first phase"));
  CHECK_THAT(error_of(give_up_in_phase(2)), Contains("my.toml:14:11: manoeuvre[0].phase[2].give_up must not be in"));
  CHECK_THAT(error_of(give_up_in_phase(1, "{}")),
             Contains("my.toml:11:11: manoeuvre[0].phase[1].give_up must state x_below_m, pitch_below_rad or both"));
  CHECK_THAT(error_of(give_up_in_phase(1, "{ x_above_m = 1 }")),
             Contains("my.toml:11:13: manoeuvre[0].phase[1].give_up.x_above_m is not a known key"));
  CHECK_THAT(error_of(give_up_in_phase(1, "{ pitch_below_rad = -4 }")),
             Contains("my.toml:11:31: manoeuvre[0].phase[1].give_up.pitch_below_rad is -4"));
  CHECK_THAT(error_of(give_up_in_phase(1, "0.5")), Contains("manoeuvre[0].phase[1].give_up must be a table"));
}

TEST_CASE("What is wrong in a manoeuvre is named with its place") {
  CHECK_THAT(error_with("at_most_s = 2.5", "at_most_s = 0"),
             Contains("my.toml:6:13: phase[0].at_most_s is 0, but must be more than 0 to 3600"));
  CHECK_THAT(error_with("[0.1, 0.2]", "[0.1]"), Contains("my.toml:4:13: phase[0].track_mps must be a list of 2"));
  CHECK_THAT(error_with("0.3, 0.4]", "0.3, 70]"), Contains("my.toml:5:31: phase[0].flipper_rad is 70"));
  CHECK_THAT(error_with("turned_rad", "tuned_rad"), Contains("my.toml:7:1: phase[0].tuned_rad is not a known key"));
  CHECK_THAT(error_with("\"second\"", "\"first\""), Contains("my.toml:16:8: manoeuvre[1].name \"first\" is that of"));
  CHECK_THAT(error_with("\"second\"", "\"a b\""), Contains("manoeuvre[1].name must not be empty nor hold blanks"));
  CHECK_THAT(error_with("world = \"flat\"", ""), Contains("my.toml:9:1: manoeuvre[0].world is missing"));
  CHECK_THAT(error_with("x_above_m = 1.0", "y_above_m = 1.0"), Contains("manoeuvre[0].success.y_above_m is not"));
  CHECK_THAT(error_with("= [{ track", "= [{ trick"), Contains("manoeuvre[1].phase[0].track_mps is missing"));
  CHECK_THAT(error_with("at_most_s = 1.0", "at_most_s = 3600.0"), Contains("manoeuvre[1].phase is too long"));
  CHECK_THAT(error_of("[[manoeuvre]]\nname = \"a\"\nsummary = \"\"\nworld = \"flat\""),
             Contains("my.toml:1:1: manoeuvre[0].phase is missing"));
  CHECK_THAT(error_of(""), Contains("manoeuvre is missing"));
  CHECK_THAT(error_of("a ="), Contains("my.toml:1:"));
}

TEST_CASE("The shipped manoeuvres: each name once, sorted, found by its name") {
  const auto all = shipped_manoeuvres();
  std::set<std::string> names;
  for (const Manoeuvre& manoeuvre : all) {
    CHECK((names.empty() || *names.rbegin() < manoeuvre.name));
    CHECK(names.insert(manoeuvre.name).second);
    CHECK_FALSE(manoeuvre.summary.empty());
    CHECK_FALSE(description::find_data_file("worlds", manoeuvre.world, ".sdf").empty());
  }
  for (const std::string name : {"straight",      "straight-fast",     "turn-in-place", "arc",        "square",
                                 "flipper-sweep", "random-speeds",     "speed-steps",   "drop",       "ramp",
                                 "stairs",        "step-field",        "hills",         "tilted-box", "step-50",
                                 "step-350",      "step-200-flippers", "trench-100",    "trench-150", "trench-400",
                                 "start-stop"})
    CHECK(names.contains(name));
  CHECK(load_manoeuvre("step-200-flippers").world == "step-200");
  CHECK(load_manoeuvre("random-speeds").at_most_s() == Approx(30));
}

TEST_CASE("A manoeuvre by its path, a name that is none says which there are") {
  const test::TemporaryFolder folder;
  test::write_file(folder / "two.toml", kTwo);
  CHECK_THROWS_WITH(load_manoeuvre((folder / "two.toml").string()), Contains("two.toml: holds 2 manoeuvres"));
  test::write_file(folder / "one.toml", kTwo.substr(0, kTwo.find("[[manoeuvre]]\nname = \"second\"")));
  CHECK(load_manoeuvre((folder / "one.toml").string()).name == "first");
  CHECK_THROWS_WITH(load_manoeuvre((folder / "none.toml").string()), Contains("none.toml: cannot be read"));
  CHECK_THROWS_WITH(load_manoeuvre("stepp-200"), Contains("stepp-200") && Contains("step-200-flippers"));
}
