// Faults in words, and when they come.
#include "can/candrives/fault_script.hpp"

#include <catch2/catch.hpp>

#include "tests/can/candrives/easy_robot.hpp"

using namespace kenaf;
using namespace kenaf::candrives;
using namespace std::chrono_literals;
using Catch::Contains;

namespace {

PlannedFault read(const char* words) {
  return parse_fault(words, easy_robot());
}

}  // namespace

TEST_CASE("Faults are read from words", "[fault script]") {
  PlannedFault fault = read("node 3 silent at 5");
  CHECK(fault.fault.kind == FaultKind::silent);
  CHECK(fault.fault.node == 3);
  CHECK(fault.delay == 5s);
  CHECK_FALSE(fault.at_once);
  CHECK_FALSE(fault.after_motion);

  fault = read("  flipper rear left fault 0x2310 0.5 after motion for 2  ");
  CHECK(fault.fault.kind == FaultKind::error);
  CHECK(fault.fault.node == 5);
  CHECK(fault.fault.error_code == 0x2310);
  CHECK(fault.delay == 500ms);
  CHECK(fault.after_motion);
  CHECK(fault.lasts == 2s);

  CHECK(read("track left no heartbeat watch").fault.kind == FaultKind::no_heartbeat);
  CHECK(read("all no event timer 0.5 after motion").fault.kind == FaultKind::no_event_timer);

  CHECK(read("track right first rpdo fixed").fault.kind == FaultKind::first_rpdo_fixed);
  CHECK(read("track left no current").fault.kind == FaultKind::no_current);
  CHECK(read("node 1 no voltage for 1").fault.kind == FaultKind::no_voltage);
  CHECK(read("flipper rear left home offset negative").fault.kind == FaultKind::home_offset_negative);
  CHECK(read("all missing commands fault").fault.kind == FaultKind::missing_commands_fault);

  fault = read("bus garbage for 1");
  CHECK(fault.fault.kind == FaultKind::garbage);
  CHECK(fault.at_once);
  CHECK(fault.lasts == 1s);
  CHECK(read("inclinometer sdo wrong toggle").fault.kind == FaultKind::sdo_wrong_toggle);
  CHECK(read("gyro short pdos").fault.node == 8);
  CHECK(read("all healed").fault.node == 0);

  fault = read("\tnode\t3\tsilent\tat\t5\r");  // of a file with tabs, written elsewhere
  CHECK(fault.fault.kind == FaultKind::silent);
  CHECK(fault.fault.node == 3);
  CHECK(fault.delay == 5s);
  CHECK(read("all healed\r").fault.kind == FaultKind::healed);
}

TEST_CASE("Words that are no fault are refused with what would be one", "[fault script]") {
  CHECK_THROWS_WITH(read("wheel silent"), Contains("'wheel silent'") && Contains("track left"));
  CHECK_THROWS_WITH(read("node 9 silent"), Contains("1, 2, 3, 4, 5, 6, 7, 8, not 9"));
  CHECK_THROWS_WITH(read("node 3"), Contains("it must name one of silent"));
  CHECK_THROWS_WITH(read("node 3 fault 70000"), Contains("from 1 to 65535"));
  CHECK_THROWS_WITH(read("node 3 silent at five"), Contains("after 'at' there must be seconds"));
  CHECK_THROWS_WITH(read("node 3 silent 5 after lunch"), Contains("after motion"));
  CHECK_THROWS_WITH(read("node 3 silent at 5 please"), Contains("'please' is not understood"));
  CHECK_THROWS_WITH(read("node 3 silently"), Contains("it must name one of"));
}

TEST_CASE("Faults come at their time, after motion once it has begun, and go", "[fault script]") {
  FaultScript script(10s);  // the program began at 10 s
  script.add(read("node 3 silent at 5"), 10s);
  script.add(read("node 1 deaf 0.5 after motion for 2"), 10s);
  CHECK(script.deadline() == 15s);
  CHECK(script.due(14999ms).empty());
  CHECK(script.due(15s).at(0).kind == FaultKind::silent);
  CHECK(script.deadline() == canopen::Time::max());

  script.on_motion(20s);
  script.on_motion(21s);  // it moves already
  CHECK(script.deadline() == 20500ms);
  CHECK(script.due(21s).at(0).kind == FaultKind::deaf);
  CHECK(script.deadline() == 22500ms);
  const auto healed = script.due(22500ms);
  REQUIRE(healed.size() == 1);
  CHECK(healed[0].kind == FaultKind::healed);
  CHECK(healed[0].node == 1);

  script.add(read("node 2 silent"), 30s);
  CHECK(script.due(30s).size() == 1);
}
