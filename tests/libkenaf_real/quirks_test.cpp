// Drives that do not do what the standards say, one quirk at a time: with the key of a device file the robot drives as
// any other; without it the library refuses, or warns, with the drive's name and that key.
#include <catch2/catch.hpp>

#include <set>

#include "hrt/error.hpp"
#include "tests/libkenaf_real/changed_robot.hpp"
#include "tests/libkenaf_real/robot_on_bus.hpp"

using namespace kenaf;
using namespace kenaf::real;
using candrives::FaultKind;
using canopen::PowerState;

namespace {

enum class Of { tracks, flippers, all };

// A device file of these keys, and the shipped robot with tracks or flippers of that type. Tracks measure their speed
// in turns a minute, which fit in 16 bits.
class RobotOfDevice {
 public:
  explicit RobotOfDevice(const std::string& keys, Of of = Of::all, const std::string& homing = "")
      : robot_(changes(keys, of, homing)) {}
  std::string path() const { return robot_.path(); }
  std::string device() const { return (folder_.path() / "strange.toml").string(); }

 private:
  std::vector<std::pair<std::string, std::string>> changes(const std::string& keys, Of of,
                                                           const std::string& homing) const {
    std::ofstream(device()) << keys << '\n';
    const std::string named = "device = \"" + device() + "\"\n";
    return {{"[can.track]\n", "[can.track]\n" + (of == Of::flippers ? "" : named)},
            {"velocity_units_per_turn = 4096.0", "velocity_units_per_turn = 60.0"},
            {"[can.flipper]\n", "[can.flipper]\n" + (of == Of::tracks ? "" : named)},
            {"\n[can.inclinometer]", homing + "\n[can.inclinometer]"}};
  }
  support::TemporaryFolder folder_;
  ChangedRobot robot_;
};

struct Quirk {
  FaultKind fault;
  canopen::NodeId node;
  std::string key;          // that the drive needs; "": none
  bool refused = true;      // without it; false: the robot drives, with a warning if there is a key
  std::string homing = {};  // of the flippers; "": none
};

const std::vector<Quirk> kQuirks = {
    {FaultKind::mode_locked, 1, "mode_change = \"disabled\""},
    {FaultKind::mode_locked, 4, "mode_change = \"disabled\""},
    {FaultKind::old_target, 1, "zero_target_by_sdo = true"},
    {FaultKind::halt_blocks_mode, 2, "halt_blocks_mode = true"},
    {FaultKind::count_first, 1, "mapping_count_first = true"},
    {FaultKind::first_rpdo_fixed, 1, "command_pdo = 2"},
    {FaultKind::first_rpdo_fixed, 5, "command_pdo = 4"},
    {FaultKind::slow_commands, 1, "command_every = 3"},
    {FaultKind::slow_commands, 3, "command_every = 3"},
    {FaultKind::slow_fault_reset, 2, "fault_reset_cycles = 5"},
    {FaultKind::slow_boot, 1, "boot_s = 12"},
    {FaultKind::fixed_mapping, 1, "mapping = \"cia402\""},
    {FaultKind::fixed_mapping, 6, "mapping = \"cia402\""},
    {FaultKind::sdo_garbage, 1, "", false},
    {FaultKind::velocity_unsigned, 1, "velocity = \"magnitude\"", false},
    {FaultKind::velocity_16_bits, 2, "velocity = \"16 bits\"", false},
    {FaultKind::position_16_bits, 1, "position_bits = 16"},
    {FaultKind::position_24_bits, 1, "position_bits = 24"},
    {FaultKind::guarding_only, 1, "error_control = \"node guarding\""},
    {FaultKind::no_current, 2, "currents = false"},
    {FaultKind::no_current, 3, "currents = false"},
    {FaultKind::no_voltage, 1, "battery = false"},
    {FaultKind::home_offset_negative, 4, "home_offset_direction = -1", true, kHomeHere},
};

void inject(RobotOnBus& robot, FaultKind fault, canopen::NodeId first, canopen::NodeId last) {
  for (canopen::NodeId node = first; node <= last; ++node) {
    robot.wire.inject({fault, node});
    // the only quirk that is about faults
    if (fault == FaultKind::slow_fault_reset) robot.wire.inject({FaultKind::error, node, 0x2310});
  }
  robot.wire.run_until(robot.wire.now() + std::chrono::milliseconds(10));
}

// Half a second backwards and half a second forwards, so that counters wrap and signs change, while a flipper moves.
// The tracks go 0.05 m at 0.1 m/s; the ramps, 0.02 s each at 5 m/s^2, cost up to 0.004 m, and a command that is late by
// 0.03 s up to 0.006 m where the direction changes.
void check_drives(RobotOnBus& robot) {
  robot::Command back = drive_at(-0.1, -0.1), forward = drive_at(0.1, 0.1);
  for (robot::Command* command : {&back, &forward}) {
    for (robot::JointCommand& flipper : command->flipper) flipper = {robot::JointMode::angle, 0.3};
  }
  const robot::State begin = robot.run(1, robot::Command{});
  robot::State state = robot.run(50, back);
  for (const std::size_t track : {0u, 1u}) {
    CHECK(state.track_m[track] - begin.track_m[track] == Approx(-0.05).margin(0.01));
    CHECK(state.track_mps[track] == Approx(-0.1).margin(0.005));
  }
  state = robot.run(50, forward);
  for (const std::size_t track : {0u, 1u}) {
    CHECK(state.track_m[track] - begin.track_m[track] == Approx(0).margin(0.01));
    CHECK(state.track_mps[track] == Approx(0.1).margin(0.005));
  }
  for (const double angle_rad : state.flipper_rad) CHECK(angle_rad == Approx(0.3).margin(0.01));
}

std::string error_of(const std::function<void()>& what) {
  try {
    what();
  } catch (const hrt::Error& error) {
    CHECK(error.code() == HRT_E_DEVICE);
    return error.what();
  }
  return {};
}

// The part that the drive moves: a counter of 16 bits would be too short for the flippers' range.
Of part_of(const Quirk& quirk) {
  return quirk.node <= robot::kTrackCount ? Of::tracks : Of::flippers;
}

}  // namespace

TEST_CASE("A drive with a quirk drives as any other once its device file names it") {
  for (const Quirk& quirk : kQuirks) {
    CAPTURE(static_cast<int>(quirk.fault), quirk.node, quirk.key);
    const RobotOfDevice described(quirk.key, part_of(quirk), quirk.homing);
    RobotOnBus robot(described.path());
    if (part_of(quirk) == Of::tracks)
      inject(robot, quirk.fault, 1, 2);
    else
      inject(robot, quirk.fault, 3, 6);
    robot.open();
    check_drives(robot);
    CHECK(robot.transport.warning().empty());
    robot.transport.close();
    CHECK(robot.stands());
    CHECK(robot.all_are(PowerState::quick_stop_active));
  }
}

TEST_CASE("A drive that takes few commands is closed without a fault, and taken over with its torque") {
  for (const int every : {3, 4, 5}) {
    const RobotOfDevice described("command_every = " + std::to_string(every));
    // a command's turn may fall on any cycle of the closing
    for (int cycles = 30; cycles < 30 + every; ++cycles) {
      RobotOnBus robot(described.path());
      inject(robot, FaultKind::slow_commands, 1, 6);
      robot.open();
      robot.run(cycles, drive_at(0.2, 0.2));
      CAPTURE(every, cycles);
      CHECK_NOTHROW(robot.transport.close());
      REQUIRE(robot.all_are(PowerState::quick_stop_active));

      std::set<PowerState> seen;
      robot.wire.alter = [&](canopen::Frame&, candrives::Sender) {
        for (std::size_t drive = 0; drive < 6; ++drive) seen.insert(robot.power(drive));
        return true;
      };
      robot.open();
      CHECK(seen == std::set{PowerState::operation_enabled, PowerState::quick_stop_active});
    }
  }
}

TEST_CASE("An urgent stop goes once to a drive that takes few commands, at once") {
  const RobotOfDevice described("command_every = 3", Of::tracks);
  RobotOnBus robot(described.path());
  robot.open();
  robot.run(30, drive_at(0.2, 0.2));
  robot.wire.inject({FaultKind::error, 4, 0x2310});
  const canopen::Time begin = robot.wire.now();
  CHECK_THROWS_AS(robot.run(5, drive_at(0.2, 0.2)), hrt::Error);
  // the fault shows at the next SYNC, and its answer is on the bus in the same cycle of 10 ms
  robot.wire.run_until(robot.wire.now() + std::chrono::milliseconds(5));
  int stops = 0;
  for (const candrives::LoggedFrame& one : robot.wire.log()) {
    if (one.at < begin || one.frame.id != 0x201 || one.frame.data[0] != canopen::kControlQuickStop) continue;
    ++stops;
    CHECK(one.at - begin <= std::chrono::milliseconds(20));
  }
  CHECK(stops == 1);
}

TEST_CASE("Without its key a drive with a quirk is refused or warned of, by its name and with the key") {
  for (const Quirk& quirk : kQuirks) {
    CAPTURE(static_cast<int>(quirk.fault), quirk.node, quirk.key);
    const RobotOfDevice described("# nothing but standards", Of::all, quirk.homing);
    RobotOnBus robot(described.path());
    inject(robot, quirk.fault, quirk.node, quirk.node);
    std::string says = error_of([&] {
      robot.open();
      check_drives(robot);
    });
    CHECK(says.empty() == !quirk.refused);
    if (!quirk.refused) says = robot.transport.warning();
    if (quirk.key.empty()) {
      CHECK(says.empty());
    } else {
      const std::string name =
          robot.description.drives[quirk.node - 1u].name + " (node " + std::to_string(quirk.node) + ")";
      CHECK_THAT(says, Catch::Contains(name));
      CHECK_THAT(says, Catch::Contains(quirk.key.substr(0, quirk.key.find(' '))));
      CHECK_THAT(says, Catch::Contains("its device file (" + described.device() + ")"));
    }
  }
}

TEST_CASE("The keys of a device file do no harm to a drive that does not need them") {
  for (const Quirk& quirk : kQuirks) {
    // CiA 301 forbids what this key is for: a mapping that changes while its PDO is valid
    if (quirk.fault == FaultKind::count_first) continue;
    CAPTURE(quirk.key);
    const RobotOfDevice described(quirk.key, part_of(quirk), quirk.homing);
    RobotOnBus robot(described.path());
    robot.open();
    check_drives(robot);
    CHECK(robot.transport.warning().empty());
  }
}

TEST_CASE("A drive that is only guarded stops by itself when its master dies, in the time that a heartbeat takes") {
  const RobotOfDevice described("error_control = \"node guarding\"");
  RobotOnBus robot(described.path());
  for (canopen::NodeId node = 1; node <= 6; ++node) robot.wire.inject({FaultKind::guarding_only, node});
  robot.open();
  robot.run(30, drive_at(0.2, 0.2));
  robot.wire.stop_master();
  // as in faults_test.cpp: 5 requests of 20 ms each, and the ramp from 0.2 m/s at 12.5 m/s^2
  const double rest_s = robot.seconds_to_rest();
  CHECK(rest_s <= 0.12 + 0.2 / 12.5 + 0.002);
  CHECK(robot.all_are(PowerState::quick_stop_active));
}

TEST_CASE("No drive moves while it is refused") {
  for (const FaultKind fault : {FaultKind::old_target, FaultKind::mode_locked, FaultKind::slow_commands}) {
    RobotOnBus robot;
    robot.wire.inject({fault, 1});
    CHECK(!error_of([&] { robot.open(); }).empty());
    CHECK(robot.plant.state().track_m[0] == 0);
    CHECK(robot.stands());
  }
}

TEST_CASE("A flipper's counter of 24 bits is continued below 0, and one too short for its range is refused") {
  const RobotOfDevice described("position_bits = 24", Of::flippers);
  RobotOnBus robot(described.path());
  for (canopen::NodeId node = 3; node <= 6; ++node) robot.wire.inject({FaultKind::position_24_bits, node});
  robot.open();
  robot::Command down;
  for (robot::JointCommand& flipper : down.flipper) flipper = {robot::JointMode::angle, -0.4};
  for (const double angle_rad : robot.run(200, down).flipper_rad) CHECK(angle_rad == Approx(-0.4).margin(0.01));

  const RobotOfDevice short_one("position_bits = 16", Of::flippers);
  CHECK_THROWS_WITH(canbus::load_robot_bus(short_one.path()),
                    Catch::Contains("device") && Catch::Contains("16 bits") && Catch::Contains("too few"));
}

TEST_CASE("A flipper whose mode is locked is homed all the same, and then takes targets") {
  const RobotOfDevice described("mode_change = \"disabled\"", Of::flippers, kHomeHere);
  RobotOnBus robot(described.path());
  for (canopen::NodeId node = 3; node <= 6; ++node) robot.wire.inject({FaultKind::mode_locked, node});
  robot.open();
  for (const double angle_rad : robot.run(2, robot::Command{}).flipper_rad)
    CHECK(angle_rad == Approx(0.7).margin(1e-3));
  robot::Command up;
  for (robot::JointCommand& flipper : up.flipper) flipper = {robot::JointMode::angle, 1.0};
  for (const double angle_rad : robot.run(200, up).flipper_rad) CHECK(angle_rad == Approx(1.0).margin(0.01));
}
