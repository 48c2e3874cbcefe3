// Recorded runs become a dataset, and more are added to it; nothing that was there is changed.
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "formats/description/data_files.hpp"
#include "formats/runs/dataset.hpp"
#include "tests/gap/kenaf_gap.hpp"

using namespace kenaf;
using test::kenaf_gap;
using test::Outcome;
using test::read_file;
using test::TemporaryFolder;
using test::write_file;

namespace {

// A run of a quarter of a second, as a robot would record it; its rows differ by `speed`.
void record(const TemporaryFolder& folder, const std::string& name, double speed = 0.2, double scale = 1) {
  runs::Run run{{"t_s", "cmd_track_left_mps", "cmd_track_right_mps", "track_left_mps", "track_right_mps", "x_m", "y_m"},
                {}};
  run.values.resize(run.columns.size());
  for (int i = 0; i < 300; ++i) {
    const double t = 0.01 * i, row[] = {t, speed, speed, speed, speed, scale * speed * t, 0};
    for (std::size_t c = 0; c < run.columns.size(); ++c) run.values[c].push_back(row[c]);
  }
  runs::write_run(folder / name, run);
}

}  // namespace

TEST_CASE("Runs become a dataset that reads back, each with its manoeuvre and that one's world") {
  const TemporaryFolder folder;
  record(folder, "a.csv");
  record(folder, "b.csv", 0.3);
  const Outcome outcome =
      kenaf_gap(folder, "dataset a.csv step-200=b.csv --manoeuvre straight --description 'dry concrete' --out data");
  CHECK(outcome.error == "");
  REQUIRE(outcome.status == 0);
  CHECK(outcome.out == "a.csv: straight, from a.csv\nb.csv: step-200, from b.csv\ndata: 2 runs in a new dataset\n");
  const runs::Dataset dataset = runs::read_dataset(folder / "data");
  CHECK(dataset.source == "real");
  CHECK(dataset.robot == "kenaf");
  CHECK(dataset.world == "flat");
  CHECK(dataset.description == "dry concrete");
  REQUIRE(dataset.runs.size() == 2);
  CHECK(dataset.runs[0].world == "");
  CHECK(dataset.runs[1].world == "step-200");
  CHECK(read_file(folder / "data/b.csv") == read_file(folder / "b.csv"));
  CHECK(kenaf_gap(folder, "check data").status == 0);
}

TEST_CASE("Runs are added at the end, what somebody wrote into dataset.toml stays, and no file is replaced") {
  const TemporaryFolder folder;
  record(folder, "a.csv");
  REQUIRE(kenaf_gap(folder, "dataset a.csv --manoeuvre straight --out data").status == 0);
  const std::string mine = "# by hand\nlicence = \"BSD\"\n" + read_file(folder / "data/dataset.toml");
  write_file(folder / "data/dataset.toml", mine);
  const std::string first = read_file(folder / "data/a.csv");
  record(folder, "a.csv", 0.25);
  const Outcome outcome = kenaf_gap(folder, "dataset a.csv a.csv --manoeuvre straight --out data");
  INFO(outcome.error);
  REQUIRE(outcome.status == 0);
  CHECK_THAT(outcome.out, Catch::StartsWith("a-2.csv: straight, from a.csv\na-3.csv: straight, from a.csv\n"));
  CHECK_THAT(read_file(folder / "data/dataset.toml"), Catch::StartsWith(mine));
  CHECK(runs::read_dataset(folder / "data").runs.size() == 3);
  CHECK(read_file(folder / "data/a.csv") == first);
  CHECK(read_file(folder / "data/a-3.csv") == read_file(folder / "a.csv"));
}

TEST_CASE("One odd run of many is left out by name, more than a tenth or --strict refuse the dataset") {
  const TemporaryFolder folder;
  std::string files;
  for (int i = 0; i < 9; ++i) {
    const std::string name = "run-" + std::to_string(i) + ".csv";
    record(folder, name, 0.2 + 0.01 * i);
    files += name + " ";
  }
  record(folder, "mm.csv", 0.2, 1000);
  // one of ten
  const Outcome strict = kenaf_gap(folder, "dataset " + files + "mm.csv --manoeuvre straight --out data --strict");
  CHECK(strict.status == 2);
  CHECK_FALSE(std::filesystem::exists(folder / "data"));
  const Outcome outcome = kenaf_gap(folder, "dataset mm.csv " + files + "--manoeuvre straight --out data");
  REQUIRE(outcome.status == 0);
  CHECK_THAT(outcome.error, Catch::Contains("mm.csv: x_m: looks like millimetres"));
  CHECK_THAT(outcome.out, Catch::StartsWith("run-0.csv: straight, from run-0.csv\n") &&
                              Catch::EndsWith("mm.csv: left out, as it is refused\ndata: 9 runs in a new dataset\n"));
  CHECK(runs::read_dataset(folder / "data").runs.size() == 9);
  CHECK_FALSE(std::filesystem::exists(folder / "data/mm.csv"));

  // the same of a dataset that was made without checks
  REQUIRE(kenaf_gap(folder, "dataset " + files + "mm.csv --manoeuvre straight --out all --unchecked").status == 0);
  const Outcome checked = kenaf_gap(folder, "check all");
  CHECK(checked.status == 0);
  CHECK_THAT(checked.out, Catch::EndsWith("10 runs; findings: 1 refused, 0 warned of\n"
                                          "a diagnosis leaves 1 of 10 runs out; with --strict they refuse the "
                                          "dataset\n"));
  CHECK(kenaf_gap(folder, "check all --strict").status == 2);
  // two of ten
  record(folder, "mm-2.csv", 0.3, 1000);
  CHECK(
      kenaf_gap(folder, "dataset mm-2.csv mm.csv " + files.substr(0, 80) + " --manoeuvre straight --out two").status ==
      2);
}

TEST_CASE("A counter that wraps refuses a run, and with --unwrap its travel goes on in the dataset") {
  const TemporaryFolder folder;
  record(folder, "a.csv");
  // 0.2 m/s for 3 s; the counters fall from 0.25 m back to 0, at 1.25 s and 2.5 s
  runs::Run run = runs::read_run(folder / "a.csv");
  for (const char* name : {"track_left_m", "track_right_m"}) {
    run.columns.push_back(name);
    run.values.emplace_back();
    for (const double t_s : run.values[0]) run.values.back().push_back(std::fmod(0.2 * t_s + 1e-9, 0.25));
  }
  runs::write_run(folder / "wraps.csv", run);
  const Outcome refused = kenaf_gap(folder, "dataset wraps.csv --manoeuvre straight --out data");
  CHECK(refused.status == 2);
  CHECK_THAT(refused.error, Catch::Contains("wraps.csv:127: track_left_m: jumps by 0.25 m, 2 times"));
  const Outcome outcome = kenaf_gap(folder, "dataset wraps.csv a.csv --manoeuvre straight --out data --unwrap");
  INFO(outcome.error);
  REQUIRE(outcome.status == 0);
  CHECK_THAT(outcome.out, Catch::StartsWith("wraps.csv: track_left_m: unwrapped 2 times by 0.25 m\n"
                                            "wraps.csv: track_right_m: unwrapped 2 times by 0.25 m\n"));
  CHECK(runs::read_run(folder / "data/wraps.csv").column("track_right_m").back() == Approx(0.2 * 2.99).margin(1e-6));
  CHECK(read_file(folder / "data/a.csv") == read_file(folder / "a.csv"));
}

TEST_CASE("A dataset with a world and a robot of its own is added to from another folder") {
  const TemporaryFolder folder;
  record(folder, "a.csv");
  std::filesystem::create_directory(folder / "mine");
  write_file(folder / "mine/hall.sdf", read_file(description::find_data_file("worlds", "flat", ".sdf")));
  write_file(folder / "mine/my.toml", read_file(description::find_data_file("robots", "kenaf", ".toml")));
  const std::string with_both = "dataset a.csv --manoeuvre own --world mine/hall.sdf --robot mine/my.toml --out data";
  REQUIRE(kenaf_gap(folder, with_both).status == 0);
  // hall.sdf and my.toml are beside dataset.toml; here are none of these names
  Outcome added = kenaf_gap(folder, "dataset a.csv --manoeuvre own --out data");
  CHECK(added.error == "");
  CHECK(added.status == 0);
  added = kenaf_gap(folder, with_both);
  CHECK(added.error == "");
  CHECK(added.status == 0);
  const runs::Dataset dataset = runs::read_dataset(folder / "data");
  CHECK(dataset.robot == "my.toml");
  CHECK(dataset.world == "hall.sdf");
  REQUIRE(dataset.runs.size() == 3);
  for (const runs::DatasetRun& run : dataset.runs) CHECK(run.world.empty());  // the dataset's
  write_file(folder / "mine/my.toml", read_file(folder / "mine/my.toml") + "\n# another one\n");
  CHECK_THAT(kenaf_gap(folder, with_both).error, Catch::Contains("its robot is 'data/my.toml', not 'mine/my.toml'"));
}

TEST_CASE("A robot that was changed since its dataset was made is not that dataset's") {
  const TemporaryFolder folder;
  record(folder, "a.csv");
  const std::string kenaf = read_file(description::find_data_file("robots", "kenaf", ".toml"));
  write_file(folder / "my.toml", kenaf);
  const std::string command = "dataset a.csv --manoeuvre straight --robot my.toml --out data";
  REQUIRE(kenaf_gap(folder, command).status == 0);
  CHECK(kenaf_gap(folder, command).status == 0);
  write_file(folder / "my.toml", kenaf + "\n# another one\n");
  const Outcome changed = kenaf_gap(folder, command);
  CHECK(changed.status == 2);
  CHECK_THAT(changed.error, Catch::Contains("its robot is 'data/my.toml', not 'my.toml'"));
  CHECK(runs::read_dataset(folder / "data").runs.size() == 2);
  std::filesystem::remove(folder / "my.toml");  // the dataset's name of its own
  CHECK(kenaf_gap(folder, command).status == 0);
}

TEST_CASE("A disk that gets full leaves nothing behind") {
  if (!std::filesystem::exists("/dev/full")) return;
  const TemporaryFolder folder;
  record(folder, "a.csv");
  write_file(folder / "hall.sdf", read_file(description::find_data_file("worlds", "flat", ".sdf")));
  REQUIRE(kenaf_gap(folder, "dataset a.csv --manoeuvre straight --out data").status == 0);
  const std::string before = read_file(folder / "data/dataset.toml");
  for (const char* file : {"dataset.toml.part", "hall.sdf.part"}) {
    INFO(file);
    std::filesystem::create_symlink("/dev/full", folder.path() / "data" / file);
    const Outcome full = kenaf_gap(folder, "dataset a.csv --manoeuvre straight --world hall.sdf --out data");
    CHECK(full.status == 2);
    CHECK_THAT(full.error, Catch::Contains("No space left"));
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "data"))
      names.insert(entry.path().filename().string());
    CHECK(names == std::set<std::string>{"a.csv", "dataset.toml"});
    CHECK(read_file(folder / "data/dataset.toml") == before);
  }
}

TEST_CASE("A file of the dataset that is called like an unfinished copy stays") {
  const TemporaryFolder folder;
  record(folder, "a.csv");
  std::filesystem::rename(folder / "a.csv", folder / "a.csv.part");
  REQUIRE(kenaf_gap(folder, "dataset a.csv.part --manoeuvre straight --out data").status == 0);
  const std::string first = read_file(folder / "data/a.csv.part");
  record(folder, "a.csv", 0.25);
  REQUIRE(kenaf_gap(folder, "dataset a.csv --manoeuvre straight --out data").status == 0);
  CHECK(read_file(folder / "data/a.csv.part") == first);
  CHECK(runs::read_dataset(folder / "data").runs.at(1).file == "a-2.csv");
}

TEST_CASE("What is no run, or not plausible, writes nothing, and says why") {
  const TemporaryFolder folder;
  record(folder, "a.csv");
  record(folder, "mm.csv", 0.2, 1000);
  write_file(folder / "bad.csv", "t_s,x_m\n0,0\n0,1\n");
  std::filesystem::create_directory(folder / "taken");
  write_file(folder / "taken/file.txt", "mine");
  for (const auto& [arguments, words] :
       {std::pair{"dataset a.csv bad.csv --manoeuvre straight --out data", "bad.csv:3:1: t_s does not increase"},
        {"dataset a.csv mm.csv --manoeuvre straight --out data", "mm.csv: x_m: looks like millimetres"},
        {"dataset a.csv none.csv --manoeuvre straight --out data", "none.csv: cannot be opened"},
        {"dataset a.csv --out data", "a.csv: its manoeuvre is unknown"},
        {"dataset a.csv --manoeuvre of-my-own --out data", "there is no shipped manoeuvre 'of-my-own'"},
        {"dataset a.csv --manoeuvre straight --robot nobody --out data", "nobody"},
        {"dataset a.csv --manoeuvre straight --out taken", "taken: is not empty"},
        {"dataset a.csv --manoeuvre straight", "--out is required"},
        {"dataset --out data", "RUN is required"}}) {
    INFO(arguments);
    const Outcome outcome = kenaf_gap(folder, arguments);
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.error, Catch::Contains(words));
    CHECK_FALSE(std::filesystem::exists(folder / "data"));
  }
  CHECK(read_file(folder / "taken/file.txt") == "mine");
  CHECK(kenaf_gap(folder, "dataset mm.csv --manoeuvre straight --unchecked --out data").status == 0);
  CHECK(kenaf_gap(folder, "dataset a.csv --manoeuvre of-my-own --world step-50 --out data").status == 0);
  const std::string before = read_file(folder / "data/dataset.toml");
  CHECK_THAT(kenaf_gap(folder, "dataset a.csv --manoeuvre straight --robot p2at --out data").error,
             Catch::Contains("its robot is 'kenaf', not 'p2at'"));
  write_file(folder / "data/dataset.toml",
             "format = \"kenaf-runs/1\"\nsource = \"real\"\nrobot = \"kenaf\"\nworld = "
             "\"flat\"\nrun = [{file = \"mm.csv\"}]\n");
  const auto files = [&] {
    const std::filesystem::directory_iterator all(folder / "data");
    return std::distance(begin(all), end(all));
  };
  const auto count = files();
  write_file(folder / "hall.sdf", read_file(description::find_data_file("worlds", "flat", ".sdf")));
  CHECK(kenaf_gap(folder, "dataset a.csv --manoeuvre straight --world hall.sdf --out data").status == 2);
  CHECK(files() == count);
}

TEST_CASE("A run that cannot be read counts as refused, and the others are checked, collected and diagnosed") {
  const TemporaryFolder folder;
  std::string files;
  for (int i = 0; i < 10; ++i) {
    const std::string name = "run-" + std::to_string(i) + ".csv";
    record(folder, name, 0.2 + 0.01 * i);
    files += name + " ";
  }
  // the stamp of the second row comes twice
  const std::string good = read_file(folder / "run-0.csv");
  const std::size_t second = good.find('\n', good.find('\n') + 1) + 1, third = good.find('\n', second) + 1;
  write_file(folder / "twice.csv", good.substr(0, third) + good.substr(second));
  const Outcome outcome = kenaf_gap(folder, "dataset twice.csv " + files + "--manoeuvre straight --out data");
  INFO(outcome.error);
  REQUIRE(outcome.status == 0);
  CHECK_THAT(outcome.error, Catch::Contains("twice.csv:4:1: t_s does not increase from the row before: a duplicate "
                                            "stamp") &&
                                Catch::Contains("kenaf-gap import"));
  CHECK_THAT(outcome.out, Catch::Contains("twice.csv: left out, as it is refused\ndata: 10 runs in a new dataset"));

  // the same in a dataset that is there
  write_file(folder / "data/run-3.csv", read_file(folder / "twice.csv"));
  Outcome checked = kenaf_gap(folder, "check data");
  CHECK(checked.status == 0);
  CHECK_THAT(checked.out, Catch::StartsWith("run-3.csv: cannot be read: data/run-3.csv:4:1: t_s does not increase") &&
                              Catch::Contains("10 runs; findings: 1 refused, 0 warned of\na diagnosis leaves 1 of 10"));
  CHECK(kenaf_gap(folder, "check data --strict").status == 2);
  std::filesystem::remove(folder / "data/run-4.csv");
  checked = kenaf_gap(folder, "check data");
  CHECK(checked.status == 2);
  CHECK_THAT(checked.out, Catch::Contains("run-4.csv: cannot be read: data/run-4.csv: cannot be opened"));

  // unchecked is no way to read what cannot be read
  CHECK(kenaf_gap(folder, "dataset twice.csv --manoeuvre straight --unchecked --out none").status == 2);
  CHECK_FALSE(std::filesystem::exists(folder / "none"));
}

TEST_CASE("A dataset may be named by its dataset.toml where it is checked, elsewhere the error names its folder") {
  const TemporaryFolder folder;
  record(folder, "a.csv");
  REQUIRE(kenaf_gap(folder, "dataset a.csv --manoeuvre straight --out data").status == 0);
  const Outcome checked = kenaf_gap(folder, "check data/dataset.toml");
  CHECK(checked.status == 0);
  CHECK_THAT(checked.out, Catch::EndsWith("1 runs; findings: 0 refused, 0 warned of\n"));
  CHECK_THAT(kenaf_gap(folder, "diagnose data/dataset.toml --out report").error,
             Catch::Contains("data/dataset.toml: is the file of a dataset; give its folder, data"));
}

TEST_CASE("Runs whose y is mirrored are refused together, and taken unchecked") {
  // a circle of 0.5 m at 0.3 m/s, whose y counts to the right: six runs of 6 s, each a little faster
  const TemporaryFolder folder;
  std::string files;
  for (int k = 0; k < 6; ++k) {
    runs::Run run{{"t_s", "cmd_track_left_mps", "cmd_track_right_mps", "track_left_mps", "track_right_mps", "x_m",
                   "y_m", "yaw_rad"},
                  {}};
    run.values.resize(run.columns.size());
    const double v = 0.3 + 0.01 * k, w = v / 0.5;
    for (int i = 0; i < 300; ++i) {
      const double t = 0.02 * i, row[] = {t,
                                          v - 0.3 * w,
                                          v + 0.3 * w,
                                          v - 0.3 * w,
                                          v + 0.3 * w,
                                          0.5 * std::sin(w * t),
                                          -0.5 * (1 - std::cos(w * t)),
                                          std::remainder(w * t, 6.283185307179586)};
      for (std::size_t c = 0; c < run.columns.size(); ++c) run.values[c].push_back(row[c]);
    }
    runs::write_run(folder / (std::to_string(k) + ".csv"), run);
    files += std::to_string(k) + ".csv ";
  }
  const Outcome refused = kenaf_gap(folder, "dataset " + files + "--manoeuvre arc --out data");
  CHECK(refused.status == 2);
  CHECK_THAT(refused.error, Catch::Contains("dataset.toml: y_m: is mirrored against yaw_rad"));
  REQUIRE(kenaf_gap(folder, "dataset " + files + "--manoeuvre arc --unchecked --out data").status == 0);
  const Outcome checked = kenaf_gap(folder, "check data");
  CHECK(checked.status == 2);
  CHECK_THAT(checked.out, Catch::Contains("dataset.toml: y_m: is mirrored against yaw_rad"));
  CHECK_THAT(kenaf_gap(folder, "diagnose data --out report").error,
             Catch::Contains("data/dataset.toml: y_m: is mirrored against yaw_rad"));
}
