// Faults on demand.
#include <catch2/catch.hpp>

#include "tests/can/candrives/easy_robot.hpp"

using namespace kenaf;
using namespace kenaf::candrives;
using canopen::PowerState;

TEST_CASE("A silent node neither sends nor hears, and stops by itself", "[fault]") {
  EasyRobot robot;
  robot.write(1, 0x1017, 0, 2, 100);
  robot.write(1, 0x6007, 0, 2, 3);
  robot.write(1, 0x1016, 1, 4, 0x7f0064);
  robot.enable(1, 9);
  robot.write(1, 0x60ff, 0, 4, 5000);
  robot.send("77F#05");
  robot.inject({FaultKind::silent, 1});
  for (int i = 0; i < 10; ++i) {
    CHECK(robot.wait(50).empty());
    CHECK(robot.send("77F#05").empty());
  }
  CHECK(robot.send("601#4000100000000000").empty());
  CHECK(robot.plant.state().track_mps[0] == 0);
  CHECK(robot.send("602#4000100000000000").size() == 1);
  robot.inject({FaultKind::healed, 1});
  CHECK(robot.send("601#4000100000000000").size() == 1);
}

TEST_CASE("A node that loses its power brakes, and boots anew with its first values", "[fault]") {
  EasyRobot robot;
  robot.write(1, 0x1017, 0, 2, 100);
  robot.enable(1, 9);
  robot.write(1, 0x60ff, 0, 4, 5000);
  robot.wait(100);
  robot.inject({FaultKind::power_loss, 1});
  CHECK(robot.wait(1).empty());
  CHECK(robot.plant.state().track_mps[0] == 0);
  CHECK(robot.send("601#4000100000000000").empty());
  CHECK(robot.wait(498).empty());
  CHECK(robot.wait(1) == Lines{"701#00"});
  CHECK(robot.wait(200).empty());
  CHECK(robot.value(1, 0x60ff) == 0);
  CHECK(robot.value(1, 0x6064) == 0);
}

TEST_CASE("A deaf drive stays in its state whatever the controlword", "[fault]") {
  EasyRobot robot;
  robot.inject({FaultKind::deaf, 1});
  robot.enable(1, 3);
  CHECK(robot.drive(0).power_state() == PowerState::switch_on_disabled);
  robot.inject({FaultKind::healed, 1});
  robot.enable(1, 3);
  CHECK(robot.drive(0).power_state() == PowerState::operation_enabled);
}

TEST_CASE("SDO answers can be aborts, late, or with the wrong toggle bit", "[fault]") {
  EasyRobot robot;
  SECTION("abort: 0x08000000 general") {
    robot.inject({FaultKind::sdo_abort, 1});
    CHECK(robot.send("601#4000100000000000") == Lines{"581#8000100000000008"});
  }
  SECTION("late: one second") {
    robot.inject({FaultKind::sdo_late, 1});
    CHECK(robot.send("601#4000100000000000").empty());
    CHECK(robot.wait(999).empty());
    CHECK(robot.wait(1) == Lines{"581#4300100092010200"});
  }
  SECTION("toggle: of the first segment it should be 0") {
    robot.inject({FaultKind::sdo_wrong_toggle, 1});
    CHECK(robot.send("601#4008100000000000").front().substr(0, 6) == "581#41");  // segmented; its own answer is right
    // "Kenaf s": seven bytes, more to come
    CHECK(robot.send("601#6000000000000000") == Lines{"581#104B656E61662073"});
  }
}

TEST_CASE("PDOs can lack a byte", "[fault]") {
  EasyRobot robot;
  robot.inject({FaultKind::short_pdos, 1});
  CHECK(robot.send("000#0100") ==
        Lines{"181#50", "182#5002", "183#5002", "184#5002", "185#5002", "186#5002", "187#C3FD0000"});
}

TEST_CASE("Garbage is one frame each millisecond, the same in every run, until it is healed", "[fault]") {
  EasyRobot robot, twin;
  robot.inject({FaultKind::garbage, 0});
  twin.inject({FaultKind::garbage, 0});
  const Lines garbage = robot.wait(100);
  CHECK(garbage.size() == 100);
  CHECK(twin.wait(100) == garbage);
  robot.inject({FaultKind::healed, 0});
  CHECK(robot.wait(100).empty());
}
