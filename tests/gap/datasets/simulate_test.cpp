// kenaf-gap simulate, as a user runs it: what it writes, that it repeats itself, and what it refuses.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "formats/runs/dataset.hpp"
#include "rollout/manoeuvre.hpp"
#include "tests/gap/kenaf_gap.hpp"

using namespace kenaf;
using test::kenaf_gap;
using test::Outcome;
using test::read_file;
using test::TemporaryFolder;
using test::write_file;

namespace {

// A quarter of a second, so that the tests are quick.
const std::string kShort = R"(
[[manoeuvre]]
name = "short"
summary = "a quarter of a second ahead"
world = "flat"
success = { x_above_m = 0.02 }
phase = [{ track_mps = [0.2, 0.2], at_most_s = 0.25 }]
)";

Outcome simulate(const TemporaryFolder& folder, const std::string& arguments) {
  write_file(folder / "short.toml", kShort);
  return kenaf_gap(folder, "simulate " + arguments);
}

}  // namespace

TEST_CASE("Manoeuvres as JSON: the shipped ones with only the keys that scripts rely on") {
  const TemporaryFolder folder;
  const Outcome outcome = kenaf_gap(folder, "manoeuvres --json");
  REQUIRE(outcome.status == 0);
  const auto list = nlohmann::json::parse(outcome.out);
  const auto shipped = rollout::shipped_manoeuvres();
  REQUIRE(list.size() == shipped.size());
  for (std::size_t i = 0; i < shipped.size(); ++i) {
    CHECK(list[i].size() == 4);
    CHECK(list[i].at("name") == shipped[i].name);
    CHECK(list[i].at("world") == shipped[i].world);
    CHECK(list[i].at("duration_s").get<double>() > 0);
    CHECK(list[i].at("summary") == shipped[i].summary);
  }
  const std::string text = kenaf_gap(folder, "manoeuvres").out;
  for (const auto& manoeuvre : shipped) CHECK_THAT(text, Catch::Contains(manoeuvre.summary));
}

TEST_CASE("A dataset: runs in the order asked for, repeats side by side, effects and physics noted") {
  const TemporaryFolder folder;
  const Outcome outcome =
      simulate(folder,
               "--manoeuvre ./short.toml --manoeuvre drop --repeats 2 --effect command_delay:delay_s=0.05 --effect "
               "mass:scale=1.2 --physics time_step_s=0.002 --physics contact_damping_nspm=2000 --noise 2 --out data");
  CHECK(outcome.error == "");
  REQUIRE(outcome.status == 0);
  CHECK_THAT(outcome.out, Catch::StartsWith("run-000.csv: short, 0.25 s, "));
  const runs::Dataset dataset = runs::read_dataset(folder / "data");
  CHECK(dataset.source == "sim");
  CHECK(dataset.robot == "kenaf");
  CHECK(dataset.world == "flat");
  CHECK(dataset.noise.at("x_m") == 0.002);
  for (const std::string word :
       {"command_delay:delay_s=0.05", "mass:scale=1.2", "time_step_s=0.002", "damping_nspm=2000"})
    CHECK_THAT(dataset.description, Catch::Contains(word));
  REQUIRE(dataset.runs.size() == 4);
  CHECK(dataset.runs[1].file == "run-001.csv");
  CHECK(dataset.runs[1].manoeuvre == "short");
  CHECK(dataset.runs[2].manoeuvre == "drop");
  CHECK(dataset.runs[3].world == "");  // the dataset's
  for (const runs::DatasetRun& run : dataset.runs)
    CHECK(runs::read_run(folder / ("data/" + run.file)).row_count() > 20);
  CHECK(read_file(folder / "data/run-000.csv") != read_file(folder / "data/run-001.csv"));
  // no temporary file is left
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    CHECK_THAT(entry.path().filename().string(), !Catch::Contains(".part"));
}

// The command arrives 0.1 s later: 0.1 s times 0.2 m/s less of the way.
TEST_CASE("An effect of the command line wins over the robot file's, which stays as it is in the dataset") {
  const TemporaryFolder folder;
  write_file(folder / "mine.toml",
             read_file(KENAF_SOURCE_DIR "/share/robots/kenaf.toml") + "\n[effects.command_delay]\ndelay_s = 0.05\n");
  const auto end_m = [&folder](const std::string& more) {
    const Outcome outcome =
        simulate(folder, "--manoeuvre ./short.toml --noise 0 --scatter 0 --force --out out " + more);
    CHECK(outcome.error == "");
    return runs::read_run(folder / "out/run-000.csv").column("x_m").back();
  };
  const double nominal = end_m("");
  const double from_file = end_m("--robot mine.toml");
  CHECK(runs::read_dataset(folder / "out").robot == "mine.toml");
  CHECK(read_file(folder / "out/mine.toml") == read_file(folder / "mine.toml"));
  CHECK(nominal - from_file == Approx(0.2 * 0.05).margin(0.001));
  CHECK(nominal - end_m("--robot mine.toml --effect command_delay:delay_s=0.1") == Approx(0.2 * 0.1).margin(0.001));
}

TEST_CASE("The same bytes with one job and with three, and run k whatever else is asked for") {
  const TemporaryFolder folder;
  const std::string some = " --manoeuvre ./short.toml --manoeuvre drop --repeats 2 --seed 7 ";
  REQUIRE(simulate(folder, "--jobs 1 --out one" + some).status == 0);
  REQUIRE(simulate(folder, "--jobs 3 --out three" + some).status == 0);
  for (const std::string file : {"dataset.toml", "run-000.csv", "run-001.csv", "run-002.csv", "run-003.csv"}) {
    INFO(file);
    CHECK(read_file(folder / ("one/" + file)) == read_file(folder / ("three/" + file)));
  }
  REQUIRE(simulate(folder, "--manoeuvre drop --repeats 1 --seed 7 --out alone").status == 0);
  CHECK(read_file(folder / "alone/run-000.csv") == read_file(folder / "one/run-002.csv"));
  REQUIRE(simulate(folder, "--manoeuvre drop --seed 8 --out other").status == 0);
  CHECK(read_file(folder / "other/run-000.csv") != read_file(folder / "alone/run-000.csv"));
}

TEST_CASE("Without noise and scatter, repeats and seeds are the same bytes") {
  const TemporaryFolder folder;
  const std::string exact = "--manoeuvre ./short.toml --noise 0 --scatter 0 ";
  REQUIRE(simulate(folder, exact + "--repeats 2 --out a").status == 0);
  REQUIRE(simulate(folder, exact + "--seed 5 --out b").status == 0);
  CHECK(read_file(folder / "a/run-000.csv") == read_file(folder / "a/run-001.csv"));
  CHECK(read_file(folder / "a/run-000.csv") == read_file(folder / "b/run-000.csv"));
}

TEST_CASE("A recorded run is driven again, in a world that is a file") {
  const TemporaryFolder folder;
  write_file(folder / "hall.sdf", read_file(KENAF_SOURCE_DIR "/share/worlds/flat.sdf"));
  const std::string exact = " --noise 0 --scatter 0 --world hall.sdf ";
  REQUIRE(simulate(folder, "--manoeuvre ./short.toml --out first" + exact).status == 0);
  const Outcome outcome = simulate(folder, "--manoeuvre replay:first/run-000.csv --out second" + exact);
  CHECK(outcome.error == "");
  REQUIRE(outcome.status == 0);
  const runs::Dataset dataset = runs::read_dataset(folder / "second");
  CHECK(dataset.world == "hall.sdf");
  CHECK(std::filesystem::exists(folder / "second/hall.sdf"));
  CHECK(dataset.runs.at(0).manoeuvre == "short");  // what the first dataset calls it
  const auto first = runs::read_run(folder / "first/run-000.csv"),
             second = runs::read_run(folder / "second/run-000.csv");
  REQUIRE(first.row_count() == second.row_count());
  CHECK(second.column("x_m").back() == Approx(first.column("x_m").back()).margin(1e-4));
}

TEST_CASE("A folder with something in it is left alone, or with --force written into") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "full");
  write_file(folder / "full/notes.txt", "mine");
  const Outcome refused = simulate(folder, "--manoeuvre ./short.toml --out full");
  CHECK(refused.status == 2);
  CHECK_THAT(refused.error, Catch::Contains("full: is not empty") && Catch::Contains("--force"));
  CHECK_FALSE(std::filesystem::exists(folder / "full/dataset.toml"));
  CHECK(simulate(folder, "--manoeuvre ./short.toml --out full/ --force").status == 0);
  CHECK(read_file(folder / "full/notes.txt") == "mine");
  CHECK(runs::read_dataset(folder / "full").runs.size() == 1);
  std::filesystem::create_directory(folder / "empty");
  CHECK(simulate(folder, "--manoeuvre ./short.toml --out empty").status == 0);
}

TEST_CASE("A folder that is there is written into: one behind a link, one that a killed program left something in") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "disk");
  std::filesystem::create_directory(folder / "disk/.part-abcdef");
  std::filesystem::create_directory_symlink("disk", folder / "runs");
  const Outcome outcome = simulate(folder, "--manoeuvre ./short.toml --out runs");
  CHECK(outcome.error == "");
  REQUIRE(outcome.status == 0);
  CHECK(runs::read_dataset(folder / "disk").runs.size() == 1);
  CHECK(std::filesystem::is_symlink(folder / "runs"));
}

// Nothing but a box under the start: the robot drives off it after 0.5 m of way and 2.5 s, and falls for 4.5 s more
// until it is 100 m down.
TEST_CASE("A run whose robot leaves the world: status 1, named, marked in the dataset, and not compared") {
  const TemporaryFolder folder;
  write_file(folder / "island.sdf",
             "<sdf version='1.9'><world name='island'><frame name='start_00'><pose>0 0 0 0 0 0</pose></frame>"
             "<model name='box'><static>true</static><pose>0 0 -0.5 0 0 0</pose><link name='l'><collision name='c'>"
             "<geometry><box><size>1 1 1</size></box></geometry></collision></link></model></world></sdf>");
  write_file(folder / "off.toml",
             "[[manoeuvre]]\nname = 'off'\nsummary = 'over the edge'\nworld = 'island.sdf'\n"
             "success = { z_below_m = 1.0 }\nphase = [{ track_mps = [0.2, 0.2], at_most_s = 20.0 }]\n");
  const Outcome outcome = simulate(folder, "--manoeuvre ./short.toml --manoeuvre ./off.toml --out data");
  CHECK(outcome.status == 1);
  CHECK_THAT(outcome.out, Catch::Contains("run-001.csv: off, ") && Catch::Contains(" s, failed\n"));
  CHECK_THAT(outcome.error, Catch::Contains("run-001.csv: the simulation failed: it left the world: x ") &&
                                Catch::Contains("1 of 2 runs"));
  const runs::Dataset dataset = runs::read_dataset(folder / "data");
  CHECK(dataset.runs.at(0).fault.empty());
  CHECK_THAT(dataset.runs.at(1).fault, Catch::StartsWith("it left the world"));
  // as far as it came: every row a number, and the last one from near the end of the fall
  CHECK(runs::read_run(folder / "data/run-001.csv").column("z_m").back() == Approx(-100).margin(1));

  REQUIRE(kenaf_gap(folder, "compare data data --out out").status == 0);
  const auto report = nlohmann::json::parse(read_file(folder / "out/compare.json"));
  CHECK(report["runs"].size() == 1);
  REQUIRE(report["left_out"].size() == 2);
  CHECK_THAT(report["left_out"][0]["why"].get<std::string>(), Catch::StartsWith("its simulation failed: it left"));
}

TEST_CASE("Bad input: exit status 2, what is wrong in words, and no folder") {
  const TemporaryFolder folder;
  write_file(folder / "bad.toml", kShort + "speed = 3\n");
  write_file(folder / "empty.toml", "");
  struct Case {
    std::string arguments, words;
  };
  for (const Case& c :
       {Case{"--out data", "--manoeuvre"},
        {"--manoeuvre drop", "--out"},
        {"--manoeuvre dorp --out data", "manoeuvre \"dorp\": no such manoeuvre"},
        {"--manoeuvre ./bad.toml --out data", "./bad.toml:8:1: manoeuvre[0].speed is not a known key"},
        {"--manoeuvre empty.toml --out data", "empty.toml:1:1: manoeuvre is missing"},
        {"--manoeuvre drop --robot kenoff --out data",
         "no such robot; give the path of a file that ends "
         "in .toml, or one of basicskidrobot, husky, jackal, kenaf,"},
        {"--manoeuvre drop --robot none.toml --out data", "none.toml: cannot be read: No such file"},
        {"--manoeuvre drop --robot ./ --out data", "./: is a folder, device, pipe or socket, not a file"},
        {"--manoeuvre drop --robot empty.toml --out data", "empty.toml:1:1: usarsim_class is missing"},
        {"--manoeuvre drop --world nowhere --out data", "world \"nowhere\": no such world"},
        {"--manoeuvre drop --effect mass:scale=9 --out data",
         "scale = 9 is out of range; it goes from "
         "0.5 to 2\n"},
        {"--manoeuvre drop --effect mass:scale=nan --out data", "out of range"},
        {"--manoeuvre drop --effect mass:scale=1,5 --out data", "scale = \"1,5\" is not a number"},
        {"--manoeuvre drop --effect gravity --out data", "NAME:PARAMETER=VALUE"},
        {"--manoeuvre drop --physics time_step_s=0.003 --out data", "time_step_s = 0.003"},
        {"--manoeuvre drop --physics time_step_s=1 --out data", "out of range"},
        {"--manoeuvre drop --physics time_step_s --out data", "is not a number"},
        {"--manoeuvre drop --physics solver_iterations=2.5 --out data", "not a whole number"},
        {"--manoeuvre drop --physics gravity=1 --out data", "contact_stiffness_npm"},
        {"--manoeuvre drop --repeats 0 --out data", "repeats"},
        {"--manoeuvre drop --noise -1 --out data", "--noise -1: must be a number from 0 to 1000"},
        {"--manoeuvre drop --scatter nan --out data", "--scatter nan: must be"},
        {"--manoeuvre drop --seed -1 --out data", "--seed -1: must be a whole number"},
        {"--manoeuvre drop --seed 99999999999999999999 --out data", "must be a whole number"},
        {"--manoeuvre drop --jobs 1.5 --out data", "--jobs 1.5: must be a whole number"},
        {"--manoeuvre replay:none.csv --out data", "none.csv: cannot be opened"},
        {"--manoeuvre replay:empty.toml --out data", "empty.toml:1:1: the file is empty"},
        {"--manoeuvre drop --out short.toml/data", "short.toml/data: cannot be created: Not a directory"},
        {"--manoeuvre drop --out short.toml", "short.toml: is not a folder"}}) {
    INFO(c.arguments);
    const Outcome outcome = simulate(folder, c.arguments);
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.error, Catch::Contains(c.words));
    CHECK_FALSE(std::filesystem::exists(folder / "data"));
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    CHECK_THAT(entry.path().filename().string(), !Catch::Contains(".part"));
}
