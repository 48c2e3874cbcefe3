// The table [can] of a robot's description: its numbers in the drives' units, and what is refused, with its line.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "can/canbus/bus_layout.hpp"
#include "can/canbus/robot_bus.hpp"
#include "formats/description/description_error.hpp"

using namespace kenaf;
using namespace kenaf::canbus;
using canopen::DriveMode;

namespace {

std::string kenaf_toml() {
  std::ifstream file(std::string(KENAF_SOURCE_DIR) + "/share/robots/kenaf.toml");
  return {std::istreambuf_iterator<char>(file), {}};
}

// The shipped description with the first `from` after [can] replaced.
std::string with(const std::string& from, const std::string& to) {
  std::string text = kenaf_toml();
  const std::size_t at = text.find(from, text.find("[can]"));
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

std::string error_of(const std::string& text) {
  try {
    parse_robot_bus(text, "k.toml");
  } catch (const description::DescriptionError& error) {
    return error.what();
  }
  return "";
}

// "k.toml:LINE:" of the line that holds `part`.
std::string at_line(const std::string& text, const std::string& part) {
  const std::size_t at = text.find(part);
  REQUIRE(at != std::string::npos);
  return "k.toml:" + std::to_string(1 + std::count(text.begin(), text.begin() + static_cast<long>(at), '\n')) + ":";
}

}  // namespace

TEST_CASE("The shipped robot's bus is read as its description says") {
  const RobotBus bus = load_robot_bus("kenaf");
  CHECK(bus.interface == "can0");
  CHECK(bus.bit_rate == 500'000);
  CHECK(bus.track_gauge_m == Approx(0.2));
  CHECK(bus.master == 127);
  REQUIRE(bus.drives.size() == 6);
  for (std::size_t i = 0; i < bus.drives.size(); ++i) CHECK(bus.drives[i].node == i + 1);
  CHECK(bus.drives[0].mode == DriveMode::profile_velocity);
  CHECK(bus.drives[5].mode == DriveMode::profile_position);
  REQUIRE(bus.inclinometer);
  CHECK(bus.inclinometer->node == 7);
  REQUIRE(bus.gyro);
  CHECK(bus.gyro->units_per_radps == 3000);
  // 0.1 s without a heartbeat, then from 0.5 m/s at 12.5 m/s^2: 0.04 s. There a drive that lags by 0.01 s is still at
  // 12.5 * 0.01 * (1 - exp(-4)) = 0.12271 m/s, and ln(12.271) = 2.5073 time constants later at 0.01 m/s.
  CHECK(longest_stop_s(bus) == Approx(0.165073).epsilon(1e-5));
}

TEST_CASE("A track's way and speed are converted to its motor's counts") {
  const RobotBus bus = load_robot_bus("kenaf");
  // one turn of a sprocket of 65 mm moves the belt by 0.4084 m and the motor by 36 turns of 4096 counts
  const double counts_per_m = 36 * 4096 / (2 * std::numbers::pi * 0.065);
  CHECK(position_to_drive(bus.drives[0].units, 1.0) == std::lround(counts_per_m));
  CHECK(velocity_to_drive(bus.drives[0].units, 0.5) == std::lround(0.5 * counts_per_m));
  CHECK(position_from_drive(bus.drives[0].units, 147456) == Approx(2 * std::numbers::pi * 0.065));
  // the right motor looks the other way: forward is negative there
  CHECK(position_to_drive(bus.drives[1].units, 1.0) == -std::lround(counts_per_m));
  CHECK(velocity_from_drive(bus.drives[1].units, -1000) > 0);
  // an acceleration has no direction
  CHECK(acceleration_to_drive(bus.drives[1].units, 5.0) == static_cast<std::uint32_t>(std::lround(5 * counts_per_m)));
}

TEST_CASE("A flipper's angle is converted to counts from where its zero is") {
  const RobotBus bus = parse_robot_bus(
      with("node = 4, direction = -1, zero_counts = 0", "node = 4, direction = -1, zero_counts = 1000"), "k.toml");
  // a right angle is a quarter turn of the arm: 75 turns of the motor, 307200 counts
  CHECK(position_to_drive(bus.drives[2].units, std::numbers::pi / 2) == 307200);
  CHECK(position_to_drive(bus.drives[3].units, std::numbers::pi / 2) == 1000 - 307200);
  CHECK(position_from_drive(bus.drives[3].units, 1000) == 0);
}

TEST_CASE("One wrong value of the bus is named with its line") {
  struct Case {
    std::string from, to, says;
    std::string line_of{};  // what stands in the line at fault, where it is not what was changed
  };
  const Case cases[] = {
      {"master_node = 127", "master_node = 128", "can.master_node is 128, but must be from 1 to 127"},
      {"node = 2, direction", "node = 0, direction", "can.track.right.node is 0"},
      {"node = 2, direction = -1", "node = 2, direction = 0", "can.track.right.direction is 0, but must be 1 or -1"},
      {"gear_ratio = 36.0", "gear_ratio = 0", "can.track.gear_ratio is 0"},
      {"gear_ratio = 36.0", "gear_ratoi = 36.0", "can.track.gear_ratio is missing", "[can.track]"},
      {"mode = \"profile velocity\"", "mode = \"profile position\"",
       "must be \"profile velocity\" or \"cyclic velocity\""},
      {"master_silence_s = 0.1", "master_silence_s = 0.03", "less than two heartbeats"},
      {"quick_stop_mps2 = 12.5", "quick_stop_mps2 = 4.9", "it must stop within 0.2 s"},
      {"axis = \"longitudinal\"", "axis = \"lateral\"", "is on the same axis of the sensor as roll", "pitch = {"},
      {"first_bit = 0", "first_bit = 56", "reaches beyond the eight bytes", "bits = 16"},
      {"interface = \"can0\"", "interface = \"an-interface-name-too-long\"", "must be of 1 to 15 characters"},
      {"interface = \"can0\"", "interface = \"can0\"\nbit_rate = 2000000",
       "can.bit_rate is 2000000, but must be from 10000 to 1000000", "bit_rate ="},
      {"bits = 16", "bits = 16\nspare = 1", "can.gyro.spare is not a known key", "spare = 1"},
  };
  for (const Case& one : cases) {
    const std::string text = with(one.from, one.to), error = error_of(text);
    CAPTURE(one.to, error);
    CHECK_THAT(error, Catch::Contains(one.says));
    CHECK_THAT(error, Catch::StartsWith(at_line(text, one.line_of.empty() ? one.to : one.line_of)));
  }
}

TEST_CASE("What a description may say of its drives' event timers and of real time") {
  const RobotBus bus = parse_robot_bus(kenaf_toml(), "k.toml");
  CHECK_FALSE(bus.event_timer);
  CHECK_FALSE(bus.realtime_priority);
  CHECK_FALSE(bus.lock_memory);
  const std::string key = "interface = \"can0\"";
  const RobotBus all =
      parse_robot_bus(with(key, key + "\nevent_timer = false\nrealtime_priority = 50\nlock_memory = true"), "k.toml");
  CHECK(all.event_timer == false);
  CHECK(all.realtime_priority == 50);
  CHECK(all.lock_memory);
  for (const char* wrong : {"event_timer = 1", "realtime_priority = 0", "realtime_priority = 100", "lock_memory = 1"}) {
    const std::string text = with(key, key + "\n" + wrong);
    CHECK_THAT(error_of(text), Catch::StartsWith(at_line(text, wrong)));
  }
}

TEST_CASE("A node that is there twice is named with both its places") {
  CHECK_THAT(error_of(with("node = 8", "node = 3")), Catch::Contains("has node 3 twice: flipper front left and gyro"));
  CHECK_THAT(error_of(with("node = 6", "node = 127")),
             Catch::Contains("has node 127 twice: the master and flipper rear right"));
}

TEST_CASE("What the drive's 32 bits cannot hold is refused") {
  // 3.14 rad of flipper at 2e7 counts a turn and a gear of 300: 3e9 counts, more than 2^31
  CHECK_THAT(
      error_of(with("counts_per_turn = 4096\ngear_ratio = 300.0", "counts_per_turn = 20000000\ngear_ratio = 300.0")),
      Catch::Contains("exceed the 32 bits"));
  CHECK_THAT(error_of(with("velocity_units_per_turn = 4096.0", "velocity_units_per_turn = 1e9")),
             Catch::Contains("do not fit in its 32 bits"));
  CHECK_THAT(error_of(with("velocity_units_per_turn = 4096.0", "velocity_units_per_turn = 1e-9")),
             Catch::Contains("less than one"));
}

TEST_CASE("A description without a bus says so") {
  const std::string text = kenaf_toml();
  CHECK_THAT(error_of(text.substr(0, text.find("[can]"))), Catch::Contains("has no table [can]"));
}

namespace {

// From the line that begins with `from` up to the one that begins with `to`, which stays.
std::string without(std::string text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find("\n" + from);
  REQUIRE(begin != std::string::npos);
  const std::size_t end = text.find("\n" + to, begin + 1);
  REQUIRE(end != std::string::npos);
  return text.erase(begin, end - begin);
}

std::string kenaf_without_flippers() {
  return without(without(kenaf_toml(), "[flipper]", "[battery]"), "[can.flipper]", "[can.inclinometer]");
}

std::vector<std::string> names_of(const RobotBus& bus) {
  std::vector<std::string> names;
  for (const DriveOnBus& drive : bus.drives) names.push_back(drive.name);
  return names;
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("The drives are those of the parts that the robot has") {
  CHECK(names_of(load_robot_bus("kenaf")) == Names{"track left", "track right", "flipper front left",
                                                   "flipper front right", "flipper rear left", "flipper rear right"});
  const RobotBus bare = parse_robot_bus(kenaf_without_flippers(), "k.toml");
  CHECK(names_of(bare) == Names{"track left", "track right"});
  CHECK_FALSE(has_flippers(bare));

  // front flippers alone
  const std::string both = kenaf_toml();
  std::string front = both;
  front.replace(both.find("[flipper]"), 9, "[flipper]\npairs = \"front\"");
  CHECK_THAT(error_of(front), Catch::Contains("can.flipper.rear_left is a flipper that this robot has not"));
  const RobotBus pair = parse_robot_bus(without(front, "rear_left", "\n[can.inclinometer]"), "k.toml");
  CHECK(names_of(pair) == Names{"track left", "track right", "flipper front left", "flipper front right"});
  CHECK(has_flippers(pair));
  front.replace(front.find("\"front\""), 7, "\"all\"");
  CHECK_THAT(error_of(front), Catch::Contains("flipper.pairs is \"all\", but must be"));
}

TEST_CASE("Drives for parts that the robot has not are refused") {
  std::string text = without(kenaf_toml(), "[flipper]", "[battery]");
  CHECK_THAT(error_of(text), Catch::Contains("can.flipper has drives for flippers, but this description has no"));
  text = with("[can.track]", "[can.wheel]");
  CHECK_THAT(error_of(text), Catch::Contains("can.wheel is for a robot on wheels; the drives of this one, which has "
                                             "tracks, belong in [can.track]"));
}

TEST_CASE("A side may have several drives, front first, each with its own direction") {
  const RobotBus bus = parse_robot_bus(
      with("left = { node = 1, direction = 1 }", "left = [{ node = 1, direction = 1 }, { node = 9, direction = -1 }]"),
      "k.toml");
  CHECK(bus.drives.size() == 7);
  CHECK(bus.drives[0].name == "track left 1");
  CHECK(bus.drives[1].name == "track left 2");
  CHECK(bus.drives[1].node == 9);
  CHECK(bus.drives[1].side == robot::kLeft);
  CHECK(bus.drives[1].units.counts_per_unit == -bus.drives[0].units.counts_per_unit);
  CHECK(bus.drives[2].name == "track right");
  CHECK(bus.drives[0].drives_of_side == 2);
  CHECK(bus.drives[1].drives_of_side == 2);
  CHECK(bus.drives[2].drives_of_side == 1);
  CHECK(bus.drives[3].drives_of_side == 1);  // a flipper

  const auto left = [](const std::string& list) {
    return with("left = { node = 1, direction = 1 }", "left = " + list);
  };
  CHECK_THAT(error_of(left("[]")), Catch::Contains("can.track.left is empty"));
  CHECK_THAT(error_of(left("3")), Catch::Contains("can.track.left must be a table, or a list of tables"));
  CHECK_THAT(error_of(left("[3]")), Catch::Contains("must hold tables only"));
  CHECK_THAT(error_of(left("[{ node = 1, direction = 1 }, { node = 1, direction = 1 }]")),
             Catch::Contains("has node 1 twice: track left 1 and track left 2"));
  std::string many = "[";
  for (int node = 20; node < 29; ++node) many += "{ node = " + std::to_string(node) + ", direction = 1 }, ";
  CHECK_THAT(error_of(left(many + "]")), Catch::Contains("lists 9 drives, but must list at most 8"));
}

TEST_CASE("Devices of others are named, with their traffic, and have no number that is the robot's") {
  const std::string monitor = "\n[[can.other]]\nname = \"battery monitor\"\nnode = 20\nbits_per_s = 1500\n";
  const RobotBus bus = parse_robot_bus(kenaf_toml() + monitor, "k.toml");
  REQUIRE(bus.others.size() == 1);
  CHECK(bus.others[0].name == "battery monitor");
  CHECK(bus.others[0].node == 20);
  CHECK(worst_case_bits_per_s(bus, 0.01) == Approx(worst_case_bits_per_s(load_robot_bus("kenaf"), 0.01) + 1500));
  CHECK_THAT(error_of(kenaf_toml() + "\n[[can.other]]\nname = \"lamp\"\nnode = 6\n"),
             Catch::Contains("has node 6 twice: flipper rear right and lamp"));
}

TEST_CASE("A robot that its ground cannot stop within 0.2 s says how long it takes") {
  // 0.1 s of silence, and 0.5 m/s at 2.5 m/s^2: 0.3 s, if the drives follow their ramps exactly
  std::string slow = with("quick_stop_mps2 = 12.5", "quick_stop_mps2 = 2.5");
  CHECK_THAT(error_of(slow), Catch::Contains("must stop within 0.2 s (can.stop_within_s)"));
  slow.replace(slow.find("answer_s = 0.5"), 14, "answer_s = 0.5\nstop_within_s = 0.31");
  std::string exact = slow;
  exact.replace(exact.find("speed_loop_s = 0.01"), 19, "speed_loop_s = 0.0");
  CHECK(longest_stop_s(parse_robot_bus(exact, "k.toml")) == Approx(0.3));
  CHECK(longest_stop_s(parse_robot_bus(exact, "k.toml"), 0.25) == Approx(0.45));

  // 2.5 * 0.01 * (1 - exp(-20)) = 0.025 m/s are left at the ramp's end, and 0.01 m/s after 0.01 s * ln(2.5) = 9.2 ms
  CHECK(longest_stop_s(parse_robot_bus(slow, "k.toml")) == Approx(0.309163).epsilon(1e-5));
  // a lag of 0.1 s: 2.5 * 0.1 * (1 - exp(-2)) = 0.21617 m/s, 0.1 s * ln(21.617) = 0.307 s
  std::string lagging = slow;
  lagging.replace(lagging.find("speed_loop_s = 0.01"), 19, "speed_loop_s = 0.1");
  CHECK_THAT(error_of(lagging),
             Catch::Contains("run for 0.607 s") && Catch::Contains("speed_loop_s") && Catch::Contains("within 0.31 s"));
  // less than 0.01 m/s at the ramp's end: 2.5 * 0.003 = 0.0075 m/s
  lagging.replace(lagging.find("speed_loop_s = 0.1"), 18, "speed_loop_s = 0.003");
  CHECK(longest_stop_s(parse_robot_bus(lagging, "k.toml")) == Approx(0.3));
}
