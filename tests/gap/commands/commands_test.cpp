// What the lists of kenaf-gap say, and how it refuses.
#include "tests/gap/kenaf_gap.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "gap/commands/progress_line.hpp"
#include "physics/effects.hpp"

using namespace kenaf;
using test::kenaf_gap;
using test::Outcome;
using test::TemporaryFolder;

TEST_CASE("Effects as JSON: the whole catalogue, and only the keys that scripts rely on") {
  const TemporaryFolder folder;
  const Outcome outcome = kenaf_gap(folder, "effects --json");
  REQUIRE(outcome.status == 0);
  const auto list = nlohmann::json::parse(outcome.out);
  REQUIRE(list.size() == physics::effect_catalogue().size());
  for (const auto& effect : list) {
    CHECK(effect.size() == 4);
    CHECK_FALSE(effect.at("summary").get<std::string>().empty());
    for (const auto& p : effect.at("parameters")) {
      CHECK(p.size() == 5);
      CHECK(p.at("min").get<double>() <= p.at("neutral").get<double>());
      CHECK(p.at("neutral").get<double>() <= p.at("max").get<double>());
      // what is listed can be given
      physics::Effects effects;
      physics::set_effect(effects, effect.at("name").get<std::string>() + ":" + p.at("name").get<std::string>() + "=" +
                                       p.at("max").dump());
      CHECK_FALSE(effects == physics::Effects{});
    }
  }
}

TEST_CASE("Effects as text: each with its stage, parameters and ranges") {
  const TemporaryFolder folder;
  const Outcome outcome = kenaf_gap(folder, "effects");
  CHECK(outcome.status == 0);
  for (const auto& effect : physics::effect_catalogue()) {
    CHECK_THAT(outcome.out, Catch::Contains(std::string(effect.name)));
    CHECK_THAT(outcome.out, Catch::Contains(std::string(effect.summary)));
  }
  CHECK_THAT(outcome.out, Catch::Contains("delay_s from 0 to 1 s; 0 changes nothing"));
}

TEST_CASE("Without a command, or with one that is not there, it says so and ends with 2") {
  const TemporaryFolder folder;
  CHECK(kenaf_gap(folder, "").status == 2);
  CHECK(kenaf_gap(folder, "effects --jason").status == 2);
  const Outcome outcome = kenaf_gap(folder, "effcts");
  CHECK(outcome.status == 2);
  CHECK_THAT(outcome.error, Catch::Contains("effcts"));
  CHECK(kenaf_gap(folder, "--help").status == 0);
  CHECK_THAT(kenaf_gap(folder, "--version").out, Catch::StartsWith("0."));
}

TEST_CASE("A mistyped word is named by the program, with where to look") {
  const TemporaryFolder folder;
  for (const auto& [arguments, words] :
       {std::pair{"effects more", "not expected: more\nkenaf-gap effects --help"},
        {"simulate --manoeuver drop --out o", "--manoeuver: no such option; did you mean --manoeuvre?"},
        {"simulate --out o", "--manoeuvre is required"},
        {"compare o", "SIM is required"}}) {
    INFO(arguments);
    const Outcome outcome = kenaf_gap(folder, arguments);
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.error, Catch::StartsWith("kenaf-gap: ") && Catch::Contains(words));
  }
}

TEST_CASE("A diagnosis replaces neither its dataset, nor the description it is asked about, nor somebody's own") {
  const TemporaryFolder folder;
  REQUIRE(kenaf_gap(folder, "simulate --manoeuvre straight --out real").status == 0);
  std::filesystem::create_directory(folder / "mine");
  test::write_file(folder / "mine/robot.toml", test::read_file(KENAF_SOURCE_DIR "/share/robots/kenaf.toml"));
  const auto refused = [&](const std::string& arguments) {
    const Outcome outcome = kenaf_gap(folder, "diagnose " + arguments);
    CHECK(outcome.status == 2);
    return outcome.error;
  };
  CHECK_THAT(refused("real --out real"), Catch::Contains("real: is the folder of the dataset"));
  CHECK_THAT(refused("real --robot mine/robot.toml --out mine"),
             Catch::Contains("mine/robot.toml: is the description to diagnose"));
  CHECK_THAT(refused("real --out mine"), Catch::Contains("mine/robot.toml: does not come from a diagnosis"));
  CHECK(test::read_file(folder / "mine/robot.toml") == test::read_file(KENAF_SOURCE_DIR "/share/robots/kenaf.toml"));
  // of one that a diagnosis wrote: the next step of whoever confirms it
  test::write_file(folder / "mine/report.json", "{}");
  CHECK_THAT(refused("real --robot mine/robot.toml --out mine"), Catch::Contains("is the description"));
  CHECK_THAT(refused("nowhere --robot mine/robot.toml --out other"), Catch::Contains("nowhere/dataset.toml"));
}

TEST_CASE("A catalogue of which nothing is left is no catalogue") {
  const TemporaryFolder folder;
  REQUIRE(kenaf_gap(folder, "simulate --manoeuvre straight --out real").status == 0);
  std::string all;
  for (const auto& effect : nlohmann::json::parse(kenaf_gap(folder, "effects --robot kenaf --json").out))
    all += (all.empty() ? "" : ",") + effect["name"].get<std::string>();
  const Outcome outcome = kenaf_gap(folder, "diagnose real --out out --without " + all);
  CHECK(outcome.status == 2);
  CHECK_THAT(outcome.error, Catch::Contains("--without leaves no effect"));
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
}

TEST_CASE("A mistyped effect is named with the one that was probably meant") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& arguments) {
    const Outcome outcome = kenaf_gap(folder, arguments);
    CHECK(outcome.status == 2);
    CHECK_FALSE(std::filesystem::exists(folder / "out"));
    return outcome.error;
  };
  CHECK_THAT(refused("simulate --manoeuvre straight --effect drive_lga:lag_s=0.1 --out out"),
             Catch::StartsWith("kenaf-gap: effect \"drive_lga\": ") && Catch::EndsWith("; did you mean drive_lag?\n"));
  REQUIRE(kenaf_gap(folder, "simulate --manoeuvre straight --out real").status == 0);
  CHECK_THAT(refused("diagnose real --out out --without mass,drive_lga"),
             Catch::EndsWith("--without drive_lga: no such effect; did you mean drive_lag?\n"));
  CHECK_THAT(refused("diagnose real --out out --without xyzzy"),
             Catch::EndsWith("--without xyzzy: no such effect; `kenaf-gap effects --robot kenaf` lists them\n"));
}

TEST_CASE("The time left is reckoned from what was done meanwhile, not from what was there before") {
  // a half in 60 s: another 60 s; of 0.6, of which 0.5 was there, a fifth of what there was to do: 4 times 60 s
  CHECK(gap::commands::time_left(0, 0.5, 60) == ", about 60 s left");
  CHECK(gap::commands::time_left(0.5, 0.6, 60) == ", about 4 min left");
  CHECK(gap::commands::time_left(0.5, 0.51, 60).empty());
}

TEST_CASE("A list that cannot be written is no success") {
  const TemporaryFolder folder;
  for (const std::string list : {"effects", "effects --json", "manoeuvres"}) {
    const std::string command = "'" KENAF_GAP "' " + list + " >/dev/full 2>'" + (folder / "error.txt").string() + "'";
    CHECK(WEXITSTATUS(std::system(command.c_str())) == 2);
    CHECK_THAT(test::read_file(folder / "error.txt"), Catch::Contains("standard output cannot be written"));
  }
}
