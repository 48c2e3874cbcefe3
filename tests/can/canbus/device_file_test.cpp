// Device files: the defaults are the standards', a wrong key is refused with its place, and [can] names a file.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "can/canbus/device_file.hpp"
#include "can/canbus/robot_bus.hpp"
#include "formats/description/description_error.hpp"
#include "formats/description/description_file.hpp"

using namespace kenaf;
using namespace kenaf::canbus;

TEST_CASE("The shipped device files are read, and the standard one has the defaults") {
  const Device standard = load_device("standard"), none;
  CHECK(standard.boot_s == none.boot_s);
  CHECK(standard.error_control == none.error_control);
  CHECK(standard.mapping == none.mapping);
  CHECK(standard.mapping_count_first == none.mapping_count_first);
  CHECK(standard.command_pdo == none.command_pdo);
  CHECK(standard.command_every == none.command_every);
  CHECK(standard.mode_change == none.mode_change);
  CHECK(standard.halt_blocks_mode == none.halt_blocks_mode);
  CHECK(standard.zero_target_by_sdo == none.zero_target_by_sdo);
  CHECK(standard.fault_reset_cycles == none.fault_reset_cycles);
  CHECK(standard.velocity == none.velocity);
  CHECK(standard.position_bits == none.position_bits);
  CHECK(standard.currents == none.currents);
  CHECK(standard.battery == none.battery);
  CHECK(standard.home_offset_direction == none.home_offset_direction);
  CHECK(load_device("fixed-mapping").mapping == Mapping::cia402);
  CHECK_FALSE(load_device("fixed-mapping").currents);
  CHECK(load_device("node-guarding").error_control == ErrorControl::node_guarding);
}

TEST_CASE("A wrong key of a device file is named with its place, and a similar one is offered") {
  const auto error_of = [](const std::string& text) {
    try {
      parse_device(text, "own", "own.toml");
    } catch (const description::DescriptionError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(error_of("boot_s = 1\nmaping = \"cia402\"") ==
        "own.toml:2:1: maping is not a known key; did you mean mapping?");
  CHECK_THAT(error_of("velocity = \"none\""), Catch::Contains("own.toml:1:12: velocity is \"none\"") &&
                                                  Catch::Contains("\"signed\" or \"16 bits\" or \"magnitude\""));
  CHECK_THAT(error_of("position_bits = 33"), Catch::Contains("position_bits is 33, but must be from 8 to 32"));
  CHECK_THAT(error_of("home_offset_direction = 0"), Catch::Contains("must be 1 or -1"));
  CHECK_THAT(error_of("mapping = \"cia402\"\ncurrents = true"), Catch::Contains("own.toml:2:12: currents"));
  CHECK_THAT(error_of("boot_s = "), Catch::StartsWith("own.toml:1:"));
}

TEST_CASE("A device is that of the drive, else of its kind, and an unknown one is refused where it is named") {
  std::string text = description::read_description_file("robot", "kenaf", ".toml").text;
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    const std::size_t at = changed.find(from, changed.find("[can"));
    REQUIRE(at != std::string::npos);
    return changed.replace(at, from.size(), to);
  };
  text = with("[can.track]\n", "[can.track]\ndevice = \"node-guarding\"\n");
  text = with("left = { node = 1,", "left = { device = \"fixed-mapping\", node = 1,");
  const RobotBus bus = parse_robot_bus(text, "robot.toml");
  CHECK(bus.drives[0].device.name == "fixed-mapping");
  CHECK(bus.drives[0].device.error_control == ErrorControl::heartbeat);
  CHECK(bus.drives[1].device.name == "node-guarding");
  CHECK(bus.drives[2].device.name.empty());
  CHECK_FALSE(bus.has_currents);  // a drive without currents is enough
  text = with("\"node-guarding\"", "\"nobody\"");
  CHECK_THROWS_WITH(parse_robot_bus(text, "robot.toml"), Catch::Contains("can.track.device is \"nobody\"") &&
                                                             Catch::Contains("no such device") &&
                                                             Catch::Contains("standard"));
}
