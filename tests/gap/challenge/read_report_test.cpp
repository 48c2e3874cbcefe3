// What a challenge's score reads of a report.
#include "gap/challenge/read_report.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/gap/kenaf_gap.hpp"

using namespace kenaf::gap;
using namespace kenaf::gap::challenge;
using kenaf::test::TemporaryFolder;
using kenaf::test::write_file;

TEST_CASE("A report of version 1 is one stage") {
  const std::string report = R"({"format": "kenaf-gap-report/1", "verdict": "named", "named": ["mass"],
    "ambiguous_sets": [["com_up", "com_left"]], "gap": {"shrink": 0.9},
    "effects": [{"name": "mass", "parameters": {"scale": {"value": 1.2, "ci95": [1.1, 1.3]}}}],
    "isolability": {"effects": ["mass", "com_up"], "angle_deg": [[0, 30], [30, 0]]}})";
  const ReadReport read = report_of(report);
  CHECK(read.named == std::vector<std::string>{"mass"});
  CHECK(read.ambiguous_sets.front().back() == "com_left");
  REQUIRE(read.stages.size() == 1);
  CHECK(read.stages[0].stage.empty());
  CHECK(read.stages[0].named == read.named);
  CHECK(read.stages[0].ambiguous_sets == read.ambiguous_sets);
  CHECK(read.stages[0].effects.at(0).to == 1.3);
  CHECK(std::isnan(read.stages[0].effects.at(0).explains));
  CHECK(read.stages[0].shrink == 0.9);
  CHECK(read.table.angle_deg[0][1] == 30);
}

TEST_CASE("A report of version 2 has names, values and shares of each stage") {
  const std::string report = R"({"format": "kenaf-gap-report/2", "verdict": "ambiguous",
    "named": ["command_slew", "track.separation_m"], "ambiguous_sets": [["mass", "com_up"]], "complete": false,
    "stages": [
      {"stage": "command to drive", "verdict": "named", "named": ["command_slew"], "ambiguous_sets": [],
       "complete": true, "explains": 0.85, "gap": {"before": 8, "after": 2, "floor": 1, "shrink": 0.87},
       "effects": [{"name": "command_slew", "explains": 0.85, "parameters": {"slowness_s2pm":
         {"value": 0.69, "ci95": [0.65, 0.72], "spread": 0.05}}}], "left": {"share": 0.15, "depends_on": []},
       "isolability": {"effects": ["command_slew", "drive_lag"], "angle_deg": [[0, 20], [20, 0]]}},
      {"stage": "drive to body", "verdict": "ambiguous", "named": ["track.separation_m"],
       "ambiguous_sets": [["mass", "com_up"]], "complete": false, "explains": 0.6, "gap": {"shrink": null},
       "effects": [
         {"name": "track.separation_m", "explains": 0.4, "parameters": {"separation_m": {"value": 0.22, "ci95": [0.21, 0.23]}}},
         {"name": "mass", "explains": null, "parameters": {"scale": {"value": 1.2, "ci95": [1.1, null]}}}]}],
    "isolability": {"effects": ["command_slew"], "angle_deg": [[0.0]]}})";
  const ReadReport read = report_of(report);
  CHECK(read.verdict == "ambiguous");
  CHECK(read.named == std::vector<std::string>{"command_slew", "track.separation_m"});
  CHECK_FALSE(read.complete);
  REQUIRE(read.stages.size() == 2);
  CHECK(read.stages[0].stage == "command to drive");
  CHECK(read.stages[0].effects.at(0).effect == "command_slew");
  CHECK(read.stages[0].effects.at(0).parameter == "slowness_s2pm");
  CHECK(read.stages[0].effects.at(0).from == 0.65);
  CHECK(read.stages[0].effects.at(0).explains == 0.85);
  CHECK(read.stages[0].shrink == 0.87);
  CHECK(read.stages[0].table.angle_deg.at(0).at(1) == 20);
  CHECK(read.stages[1].table.effects.empty());
  CHECK(read.table.effects == std::vector<std::string>{"command_slew"});
  CHECK(read.stages[1].verdict == "ambiguous");
  CHECK(read.stages[1].ambiguous_sets.at(0).at(1) == "com_up");
  CHECK(read.stages[1].effects.at(1).value == 1.2);
  CHECK(std::isnan(read.stages[1].effects.at(1).to));
  CHECK(std::isnan(read.stages[1].effects.at(1).explains));
  CHECK(std::isnan(read.stages[1].shrink));
}

TEST_CASE("What is no report is refused") {
  CHECK_THROWS_WITH(report_of("{}"), Catch::Contains("not the report of a diagnosis"));
  CHECK_THROWS_WITH(report_of("{\"format\": \"kenaf-gap-report/3\"}"), Catch::Contains("kenaf-gap-report/2"));
  CHECK_THROWS_WITH(
      report_of(R"({"format": "kenaf-gap-report/2", "verdict": "none", "named": [], "ambiguous_sets": []})"),
      Catch::Contains("stages"));
  CHECK_THROWS_WITH(report_of(R"({"format": "kenaf-gap-report/2", "verdict": "none", "named": [], "ambiguous_sets": [],
    "stages": [], "isolability": {"effects": ["mass"], "angle_deg": []}})"),
                    Catch::Contains("not a square table"));
}

TEST_CASE("What an interrupted diagnosis left is no report: unknown would be right for what is outside") {
  const TemporaryFolder folder;
  const std::string one = R"({"format": "kenaf-gap-report/1", "verdict": "unknown", "named": [],
    "ambiguous_sets": [], "effects": [], "gap": {"shrink": 0}, "isolability": {"effects": [], "angle_deg": []})";
  const std::string two = R"({"format": "kenaf-gap-report/2", "verdict": "unknown", "named": [],
    "ambiguous_sets": [], "stages": [])";
  for (const std::string& whole : {one, two}) {
    write_file(folder / "whole.json", whole + "}");
    write_file(folder / "half.json", whole + R"(, "interrupted": "while fitting"})");
    CHECK(read_report(folder / "whole.json"));
    CHECK_FALSE(read_report(folder / "half.json"));
  }
  CHECK_FALSE(read_report(folder / "none.json"));
}
