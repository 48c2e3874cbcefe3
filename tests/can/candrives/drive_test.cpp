// A drive's stops and faults, and what it says of them.
#include <catch2/catch.hpp>

#include "tests/can/candrives/easy_robot.hpp"

using namespace kenaf;
using namespace kenaf::candrives;
using canopen::PowerState;

namespace {

// Node 1 at 5000 counts/s = 0.5 m/s.
void drive_off(EasyRobot& robot) {
  robot.write(1, 0x6083, 0, 4, 100'000);
  robot.write(1, 0x6085, 0, 4, 50'000);
  robot.enable(1, 3);
  robot.write(1, 0x60ff, 0, 4, 5000);
  robot.wait(100);
  REQUIRE(robot.value(1, 0x606c) == 5000);
}

}  // namespace

TEST_CASE("Quick stop: 5000 counts/s at 50000 counts/s^2 are 100 ms and 250 counts", "[drive]") {
  EasyRobot robot;
  drive_off(robot);
  const auto before = robot.value(1, 0x6064);
  const auto stop = [&] {
    CHECK(robot.write(1, 0x6040, 0, 2, 0x02) == "581#6040600000000000");
    robot.wait(99);
    CHECK(robot.value(1, 0x606c) == 50);
    CHECK(robot.drive(0).power_state() == PowerState::quick_stop_active);
    robot.wait(1);
    CHECK(robot.value(1, 0x606c) == 0);
    // a track turns each step of 1 ms at the speed of its end: half of 5000 counts/s * 1 ms less
    CHECK(robot.value(1, 0x6064) == Approx(static_cast<double>(before) + 250 - 2.5).margin(1));
  };
  SECTION("option code 6: it stays there, target reached") {
    robot.write(1, 0x605a, 0, 2, 6);
    stop();
    robot.wait(1000);
    CHECK(robot.drive(0).power_state() == PowerState::quick_stop_active);
    CHECK(robot.value(1, 0x6041) == 0x0617);  // quick stop active, voltage, remote, target reached
  }
  SECTION("option code 2, as from the factory: then switch on disabled") {
    stop();
    CHECK(robot.drive(0).power_state() == PowerState::switch_on_disabled);
  }
  SECTION("option code 5 takes the profile's ramp: 0.5 s at 10000 counts/s^2") {
    robot.write(1, 0x605a, 0, 2, 5);
    robot.write(1, 0x6040, 0, 2, 0x02);
    robot.wait(499);
    CHECK(robot.value(1, 0x606c) == 10);
    robot.wait(1);
    CHECK(robot.value(1, 0x606c) == 0);
  }
  SECTION("disable voltage: the brake") {
    robot.write(1, 0x6040, 0, 2, 0x00);
    robot.wait(1);
    CHECK(robot.plant.state().track_mps[0] == 0);
  }
}

TEST_CASE("A lost master stops the drive within its silence and the quick stop, with 6007 = 3", "[drive]") {
  EasyRobot robot;
  robot.write(1, 0x6007, 0, 2, 3);
  robot.write(1, 0x605a, 0, 2, 6);
  robot.write(1, 0x1029, 1, 1, 1);
  robot.write(1, 0x1016, 1, 4, 0x7f0064);  // node 127, 100 ms
  drive_off(robot);
  SECTION("by silence: 100 ms, and 100 ms of ramp") {
    robot.send("77F#05");
    robot.wait(99);
    CHECK(robot.value(1, 0x606c) == 5000);
    robot.wait(100);
    CHECK(robot.value(1, 0x606c) == 50);
    robot.wait(1);
    CHECK(robot.value(1, 0x606c) == 0);
    CHECK(robot.drive(0).power_state() == PowerState::quick_stop_active);
    // its heartbeat again, and the old controlword again: it stays. Disable voltage, and the way up, start it anew
    robot.send("77F#05");
    robot.write(1, 0x6040, 0, 2, 0x0f);
    robot.wait(50);
    CHECK(robot.value(1, 0x606c) == 0);
    for (const int word : {0x00, 0x06, 0x07, 0x0f}) {
      robot.send("77F#05");
      robot.write(1, 0x6040, 0, 2, word);
    }
    robot.wait(60);
    CHECK(robot.value(1, 0x606c) == 5000);
  }
  SECTION("by NMT stop, or a reset of the communication") {
    const char* order = GENERATE("000#0201", "000#8201");
    robot.send(order);
    robot.wait(100);
    CHECK(robot.plant.state().track_mps[0] == 0);
    CHECK(robot.drive(0).power_state() == PowerState::quick_stop_active);
  }
  SECTION("with other codes: nothing, fault, disable voltage") {
    const auto [code, state] = GENERATE(table<int, PowerState>(
        {{0, PowerState::operation_enabled}, {1, PowerState::fault}, {2, PowerState::switch_on_disabled}}));
    robot.write(1, 0x6007, 0, 2, code);
    robot.send("77F#05");
    robot.wait(300);
    CHECK(robot.drive(0).power_state() == state);
  }
}

TEST_CASE("A fault: emergency message, ramp, fault, gone with the reset", "[drive]") {
  EasyRobot robot;
  drive_off(robot);
  // 0x2310 continuous over current; register: generic and current
  CHECK(robot.inject({FaultKind::error, 1, 0x2310}) == Lines{"081#1023030000000000"});
  CHECK(robot.drive(0).power_state() == PowerState::fault_reaction_active);
  CHECK(robot.value(1, 0x603f) == 0x2310);
  robot.wait(99);
  CHECK(robot.value(1, 0x606c) == 50);
  robot.wait(1);
  CHECK(robot.drive(0).power_state() == PowerState::fault);
  CHECK(robot.value(1, 0x6041) == 0x0218);  // fault, voltage, remote
  robot.write(1, 0x6040, 0, 2, 0x0f);
  CHECK(robot.drive(0).power_state() == PowerState::fault);
  CHECK(robot.send("601#2B40600080000000") == Lines{"581#6040600000000000", "081#0000000000000000"});
  CHECK(robot.drive(0).power_state() == PowerState::switch_on_disabled);
  CHECK(robot.value(1, 0x603f) == 0);
}

TEST_CASE("Fault reaction 0 takes the power away at once", "[drive]") {
  EasyRobot robot;
  robot.write(1, 0x605e, 0, 2, 0);
  drive_off(robot);
  robot.inject({FaultKind::error, 1, 0x2310});
  CHECK(robot.drive(0).power_state() == PowerState::fault);
  robot.wait(1);
  CHECK(robot.plant.state().track_mps[0] == 0);
}

TEST_CASE("A motor that does not follow is an error after the time of 6066", "[drive]") {
  // A plant whose flippers are stuck.
  class Stuck final : public Plant {
   public:
    void advance(canopen::Time, const PlantCommand&) override {}
    const PlantState& state() const override { return state_; }

   private:
    PlantState state_;
  } plant;
  RobotSlaves slaves(easy_robot(), plant, canopen::Time::zero());
  Frames out;
  int now_ms = 0;
  const auto write = [&](const char* line) { slaves.on_frame(frame(line), std::chrono::milliseconds(now_ms), out); };
  slaves.on_time(std::chrono::milliseconds(++now_ms), out);
  write("603#2365600064000000");  // window 100 counts
  write("603#2B6660000A000000");  // for 10 ms
  write("603#2381600010270000");  // 10000 counts/s
  write("603#2383600040420F00");  // 1000000 counts/s^2
  write("603#2384600040420F00");
  write("603#237A6000E8030000");  // target 1000
  for (const char* word : {"603#2B40600006000000", "603#2B40600007000000", "603#2B4060001F000000"}) write(word);
  out.clear();
  // up to speed in 10 ms = 50 counts, 50 counts more in 5 ms: outside after 15 ms, an error more than 10 ms later
  const auto start_ms = now_ms;
  while (out.empty() && now_ms < 1000) slaves.on_time(std::chrono::milliseconds(++now_ms), out);
  CHECK(texts(out) == Lines{"083#1186210000000000"});  // 0x8611, generic and device profile
  CHECK(now_ms - start_ms == Approx(26).margin(1));
  out.clear();
  slaves.on_time(std::chrono::milliseconds(now_ms += 300), out);  // the quick stop of 10000 counts/s takes 200 ms
  write("603#4041600000000000");
  CHECK(texts(out) == Lines{"583#4B41600018220000"});  // fault, voltage, remote, bit 13
}

TEST_CASE("A drive without power holds its motor, enabled, it begins where it is", "[drive]") {
  EasyRobot robot{IdealPlant({1.0, 1.0, 1.0, 1.0})};
  robot.wait(1000);
  CHECK(robot.plant.state().flipper_rad[0] == 1.0);
  CHECK(robot.value(3, 0x6064) == 10'000);  // its encoder is absolute
  CHECK(robot.value(4, 0x6064) == -10'000);
  robot.enable(3, 1);
  robot.wait(1000);
  CHECK(robot.plant.state().flipper_rad[0] == 1.0);
}

TEST_CASE("Currents are in thousandths of the rated current, voltages in mV", "[drive]") {
  class Loaded final : public Plant {
   public:
    Loaded() {
      state_.track_a[0] = 2.5;
      state_.battery_v = 25.25;
    }
    void advance(canopen::Time, const PlantCommand&) override {}
    const PlantState& state() const override { return state_; }

   private:
    PlantState state_;
  } plant;
  RobotSlaves slaves(easy_robot(), plant, canopen::Time::zero());
  Frames out;
  slaves.on_time(std::chrono::milliseconds(1), out);
  out.clear();
  const auto read = [&](const char* line) { slaves.on_frame(frame(line), std::chrono::milliseconds(1), out); };
  read("601#4075600000000000");
  read("601#4078600000000000");
  read("601#4079600000000000");
  // 10000 mA = 0x2710; 2.5 A of 10 A = 250 = 0xfa; 25250 mV = 0x62a2
  CHECK(texts(out) == Lines{"581#4375600010270000", "581#4B786000FA000000", "581#43796000A2620000"});
}
