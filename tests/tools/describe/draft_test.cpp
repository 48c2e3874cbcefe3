// The file that from-urdf writes: numbers, comments, and values given by key.
#include "tools/describe/draft.hpp"

#include <catch2/catch.hpp>

#include "formats/description/description_error.hpp"

using namespace kenaf::describe;

namespace {

Draft two_wheels() {
  Draft draft{.heading = {"A robot", ""}, .tables = {Table{}}};
  draft.tables[0].chosen("usarsim_class", "\"USARBot.A\"");
  for (int i = 0; i < 2; ++i) {
    Table wheel{.name = "wheel", .one_of_several = true, .entries = {}};
    wheel.from_urdf("radius_m", "0.1");
    wheel.chosen("width_m", "0.05", "half of the radius");
    draft.tables.push_back(wheel);
  }
  return draft;
}

}  // namespace

TEST_CASE("Numbers are TOML's floats of 12 digits, and what rounding leaves is 0") {
  CHECK(toml_number(15) == "15.0");
  CHECK(toml_number(0.1 + 0.2) == "0.3");
  CHECK(toml_number(-3e-17) == "0.0");
  CHECK(toml_number(1e-7) == "1e-07");
  CHECK(toml_number(1e15) == "1e+15");
  CHECK(toml_vector({0.5, -1, 0}) == "[0.5, -1.0, 0.0]");
}

TEST_CASE("Texts cannot leave their quotes or their comment") {
  CHECK(toml_text("a\"b\\c\nd") == R"("a\"b\\c d")");
  CHECK(comment_text("a\n[body]\x7F") == "a [body] ");
}

TEST_CASE("Each line says where its value comes from, in one column") {
  CHECK(toml_of(two_wheels()) == R"(# A robot
#

usarsim_class = "USARBot.A"               # chosen

[[wheel]]
radius_m = 0.1                            # URDF
width_m = 0.05                            # chosen: half of the radius

[[wheel]]
radius_m = 0.1                            # URDF
width_m = 0.05                            # chosen: half of the radius
)");
}

TEST_CASE("Keys that were chosen are listed once, and no longer when they are given") {
  Draft draft = two_wheels();
  CHECK(chosen_keys(draft).size() == 2);
  set_value(draft, "wheel.width_m=0.06");
  CHECK(draft.tables[1].entries[1].value == "0.06");
  CHECK(draft.tables[2].entries[1].value == "0.06");
  CHECK(chosen_keys(draft).size() == 1);
  set_value(draft, "wheel.2.width_m=0.07");
  CHECK(draft.tables[1].entries[1].value == "0.06");
  CHECK(draft.tables[2].entries[1].value == "0.07");
  set_value(draft, "usarsim_class=\"USARBot.B\"");
  CHECK(draft.tables[0].entries[0].value == "\"USARBot.B\"");
}

TEST_CASE("Wrong assignments are named") {
  Draft draft = two_wheels();
  const auto complaint = [&](const std::string& assignment) {
    try {
      set_value(draft, assignment);
    } catch (const kenaf::description::DescriptionError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  CHECK_THAT(complaint("wheel.width_m"), Catch::Contains("give KEY=VALUE"));
  CHECK_THAT(complaint("wheel.widht_m=1"), Catch::Contains("no \"wheel.widht_m\"") && Catch::Contains("wheel.width_m"));
  CHECK_THAT(complaint("wheel.3.width_m=1"), Catch::Contains("no \"wheel.3.width_m\""));
  CHECK_THAT(complaint("wheel.0.width_m=1"), Catch::Contains("no number of a table"));
  CHECK_THAT(complaint("wheel.width_m=wide"), Catch::Contains("no value of TOML"));
  CHECK_THAT(complaint("wheel.width_m=1\n[body]"), Catch::Contains("no value of TOML"));
  CHECK_THAT(complaint("wheel.width_m="), Catch::Contains("no value of TOML"));
}
