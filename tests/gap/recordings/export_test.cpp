// kenaf-gap export: what it writes is read back, and can be imported again.
#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "formats/runs/run_file.hpp"
#include "gap/recordings/recording.hpp"
#include "tests/gap/kenaf_gap.hpp"
#include "tests/gap/recordings/made_bytes.hpp"

using namespace kenaf;
using test::kenaf_gap;
using test::Outcome;
using test::TemporaryFolder;

namespace export_test {
namespace {

const std::string kRun =
    "t_s,cmd_track_left_mps,track_left_mps,track_right_mps,battery_v,x_m,yaw_rad,\"my \"\"own\"\"\"\n"
    "0,0.1,0,0.25,25.5,0,0,7\n0.01,0.1,0.01,0.5,,,,8\n0.02,0.1,0.02,-0.75,,0.001,0.5,\n";

}  // namespace

TEST_CASE("A run becomes channels by group of sensors, with units, and empty cells are left out") {
  const TemporaryFolder folder;
  test::write_file(folder / "run.csv", kRun);
  const Outcome outcome = kenaf_gap(folder, "export run.csv --out run.mcap");
  INFO(outcome.error);
  REQUIRE(outcome.status == 0);
  const gap::recordings::Recording recording = gap::recordings::open_recording(folder / "run.mcap");
  CHECK(recording.remarks.empty());
  CHECK(recording.topics.size() == 5);
  const test::Visited all = test::visited(recording);
  CHECK(all.remarks.empty());
  const auto messages_of = [&](const std::string& topic) {
    std::vector<test::Taken> found;
    for (const test::Taken& message : all.messages)
      if (message.topic == topic) found.push_back(message);
    return found;
  };
  REQUIRE(messages_of("/tracks").size() == 3);
  CHECK(messages_of("/tracks")[2].log_ns == 20000000);
  CHECK(messages_of("/tracks")[2].bytes == "{\"track_left_mps\":0.02,\"track_right_mps\":-0.75}");
  CHECK(messages_of("/commands").size() == 3);
  CHECK(messages_of("/battery").size() == 1);
  CHECK(messages_of("/pose").size() == 2);
  REQUIRE(messages_of("/other").size() == 2);
  CHECK(nlohmann::json::parse(messages_of("/other")[1].bytes).at("my \"own\"") == 8);
  for (const gap::recordings::Topic& topic : recording.topics) {
    CHECK(topic.schema_encoding == "jsonschema");
    if (topic.name == "/tracks")
      CHECK(nlohmann::json::parse(topic.schema).at("properties").at("track_left_mps").at("unit") == "m/s");
  }
}

TEST_CASE("A run that is exported and imported again is the same") {
  const TemporaryFolder folder;
  test::write_file(folder / "run.csv", kRun);
  REQUIRE(kenaf_gap(folder, "export run.csv --out run.mcap").status == 0);
  REQUIRE(kenaf_gap(folder, "import run.mcap --guess --out m.toml").status == 0);
  const Outcome outcome = kenaf_gap(folder, "import run.mcap --mapping m.toml --out again.csv");
  INFO(outcome.error);
  REQUIRE(outcome.status == 0);
  const runs::Run run = runs::read_run(folder / "run.csv"), again = runs::read_run(folder / "again.csv");
  for (const char* column : {"cmd_track_left_mps", "track_left_mps", "track_right_mps"}) {
    REQUIRE(again.row_count() == 3);
    for (std::size_t row = 0; row < 3; ++row) CHECK(again.column(column)[row] == run.column(column)[row]);
  }
  CHECK(again.column("battery_v")[0] == 25.5);
}

TEST_CASE("The curves of a diagnosis are its measured, nominal and corrected runs: of a lag, all but the nominal lag") {
  const TemporaryFolder folder;
  REQUIRE(kenaf_gap(folder, "simulate --manoeuvre speed-steps --effect drive_lag:lag_s=0.1 --out real").status == 0);
  std::string others;
  for (const auto& effect : nlohmann::json::parse(kenaf_gap(folder, "effects --robot kenaf --json").out))
    if (effect["name"] != "drive_lag") others += (others.empty() ? "" : ",") + effect["name"].get<std::string>();
  const Outcome outcome = kenaf_gap(folder, "diagnose real --no-next --curves --out out --without " + others);
  INFO(outcome.error);
  REQUIRE(outcome.status == 0);
  CHECK_THAT(outcome.out, Catch::Contains("The curves are in out/curves.mcap"));

  std::map<std::string, std::vector<double>> speeds_mps;
  for (const test::Taken& message : test::visited(gap::recordings::open_recording(folder / "out/curves.mcap")).messages)
    if (message.topic.ends_with("/tracks"))
      speeds_mps[message.topic].push_back(nlohmann::json::parse(message.bytes).at("track_left_mps"));
  REQUIRE(speeds_mps.size() == 3);
  const std::vector<double>& real = speeds_mps.at("/run-000/real/tracks");
  const auto distance = [&](const std::string& kind) {
    const std::vector<double>& simulated = speeds_mps.at("/run-000/" + kind + "/tracks");
    REQUIRE(simulated.size() == real.size());
    double sum = 0;
    for (std::size_t i = 0; i < real.size(); ++i) sum += std::abs(simulated[i] - real[i]);
    return sum;
  };
  CHECK(distance("corrected") < 0.2 * distance("nominal"));
}

TEST_CASE("Several files and datasets have topics of their own, long ones many chunks") {
  const TemporaryFolder folder;
  std::string text = "t_s,track_left_mps\n";
  for (int i = 0; i < 60000; ++i) text += std::to_string(0.01 * i) + "," + std::to_string(i % 97 * 0.01) + "\n";
  test::write_file(folder / "a.csv", text);
  std::filesystem::create_directory(folder / "b");
  test::write_file(folder / "b/a.csv", kRun);
  const Outcome outcome = kenaf_gap(folder, "export a.csv b/a.csv --out all.mcap");
  INFO(outcome.error);
  REQUIRE(outcome.status == 0);
  const gap::recordings::Recording recording = gap::recordings::open_recording(folder / "all.mcap");
  std::uint64_t of_a = 0, of_b = 0;
  std::int64_t last_ns = 0;
  const auto remarks = recording.visit(
      [&](const gap::recordings::Message& message) {
        CHECK(message.log_ns >= last_ns);
        last_ns = message.log_ns;
        const std::string& topic = recording.topics[message.topic].name;
        if (topic == "/a/tracks") ++of_a;
        if (topic == "/a-2/tracks") ++of_b;
        return true;
      },
      {});
  CHECK(remarks.empty());
  CHECK(of_a == 60000);
  CHECK(of_b == 3);
  CHECK(recording.last_ns == 599990000000);
}

TEST_CASE("Wrong uses of export are refused, and leave no file") {
  const TemporaryFolder folder;
  test::write_file(folder / "there.mcap", "");
  test::write_file(folder / "no-time.csv", "a,b\n1,2\n");
  const std::pair<std::string, std::string> cases[] = {
      {"export --out x.mcap", "FILE"},
      {"export no-time.csv", "--out"},
      {"export no-time.csv --out there.mcap", "--force"},
      {"export no-time.csv --out x.mcap", "no-time.csv: no column of time"},
      {"export missing.csv --out x.mcap", "missing.csv"},
      {"export . --out x.mcap", "without dataset.toml"},
  };
  for (const auto& [arguments, why] : cases) {
    INFO(arguments);
    const Outcome outcome = kenaf_gap(folder, arguments);
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.error, Catch::Contains(why));
    CHECK_FALSE(std::filesystem::exists(folder / "x.mcap"));
  }
}

}  // namespace export_test
