// The table [can] of a robot's description: its numbers in the drives' units, and what is refused, with its line.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <numbers>

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
  for (std::size_t i = 0; i < kDriveCount; ++i) CHECK(bus.drives[i].node == i + 1);
  CHECK(bus.drives[0].mode == DriveMode::profile_velocity);
  CHECK(bus.drives[5].mode == DriveMode::profile_position);
  REQUIRE(bus.inclinometer);
  CHECK(bus.inclinometer->node == 7);
  REQUIRE(bus.gyro);
  CHECK(bus.gyro->units_per_radps == 3000);
  // 0.1 s without a heartbeat, then from 0.5 m/s to rest at 12.5 m/s^2: 0.04 s
  CHECK(longest_stop_s(bus) == Approx(0.14));
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

TEST_CASE("A description without a bus, or without flippers, says so") {
  const std::string text = kenaf_toml();
  CHECK_THAT(error_of(text.substr(0, text.find("[can]"))), Catch::Contains("has no table [can]"));
  CHECK_THROWS_WITH(load_robot_bus("marmotte"), Catch::Contains("has no table [can]"));
}
