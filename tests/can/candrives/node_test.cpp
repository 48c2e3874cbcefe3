// What every node does, whatever its profile: NMT, SDO, heartbeats. Frames by hand; node 1 is a drive, but that does
// not matter here.
#include <catch2/catch.hpp>

#include "tests/can/candrives/easy_robot.hpp"

using namespace kenaf;
using namespace kenaf::candrives;
using namespace std::chrono_literals;

TEST_CASE("At power on every node sends its boot-up message, and nothing more", "[node]") {
  IdealPlant plant;
  RobotSlaves slaves(easy_robot(), plant, 0ms);
  Frames out;
  slaves.on_time(0ms, out);
  CHECK(texts(out) == Lines{"701#00", "702#00", "703#00", "704#00", "705#00", "706#00", "707#00", "708#00"});
  out.clear();
  slaves.on_time(10s, out);
  CHECK(out.empty());
}

TEST_CASE("NMT orders change a node's state, which its heartbeat tells", "[node]") {
  EasyRobot robot;
  // 0x1017 = 100 ms: answered, and the heartbeat begins at once
  CHECK(robot.send("601#2B17100064000000") == Lines{"581#6017100000000000", "701#7F"});
  CHECK(robot.wait(99).empty());
  CHECK(robot.wait(1) == Lines{"701#7F"});
  SECTION("start, to this node: its statusword PDO, on a change, is sent too") {
    CHECK(robot.send("000#0101") == Lines{"181#5002"});
    CHECK(robot.wait(100) == Lines{"701#05"});
    robot.send("000#8001");
    CHECK(robot.wait(100) == Lines{"701#7F"});
  }
  SECTION("stop, to all nodes: no SDO any more") {
    CHECK(robot.send("000#0200").empty());
    CHECK(robot.wait(100) == Lines{"701#04"});
    CHECK(robot.send("601#4000100000000000").empty());
    robot.send("000#8000");
    CHECK(robot.send("601#4000100000000000").size() == 1);
  }
  SECTION("orders to another node, of another length, or unknown change nothing") {
    for (const char* order : {"000#0102", "000#01", "000#010100", "000#0301"}) robot.send(order);
    CHECK(robot.slaves.slave(1)->state() == canopen::NmtState::pre_operational);
  }
}

TEST_CASE("A reset of the communication resets its objects alone, a reset of the node all", "[node]") {
  EasyRobot robot;
  robot.write(1, 0x1017, 0, 2, 50);
  robot.write(1, 0x6083, 0, 4, 77);
  CHECK(robot.send("000#8201") == Lines{"701#00"});
  CHECK(robot.value(1, 0x1017) == 0);
  CHECK(robot.value(1, 0x6083) == 77);
  CHECK(robot.wait(100).empty());
  CHECK(robot.send("000#8101") == Lines{"701#00"});
  CHECK(robot.value(1, 0x6083) == 10'000);
}

TEST_CASE("SDO reads, and says why it cannot", "[node]") {
  EasyRobot robot;
  const auto answer = [&](const char* request) {
    const Lines lines = robot.send(request);
    return lines.size() == 1 ? lines.front() : "";
  };
  // device type 0x00020192: a servo drive of profile 402
  CHECK(answer("601#4000100000000000") == "581#4300100092010200");
  CHECK(answer("601#4000300000000000") == "581#8000300000000206");  // 0x06020000 no object
  CHECK(answer("601#4040600100000000") == "581#8040600111000906");  // 0x06090011 no sub-index
  CHECK(answer("601#2B41600000000000") == "581#8041600002000106");  // 0x06010002 read only
  CHECK(answer("601#2340600006000000") == "581#8040600012000706");  // 0x06070012 four bytes into two
  CHECK(answer("601#2F40600006000000") == "581#8040600013000706");  // 0x06070013 one byte into two
  CHECK(answer("601#2316100100000001") == "581#8016100131000906");  // 0x06090031 above 0x00ffffff
  CHECK(answer("601#2FC26002F9000000") == "581#80C2600232000906");  // 0x06090032 -7, below -6
  CHECK(answer("601#2F60600002000000") == "581#8060600030000906");  // 0x06090030 a mode that it has not
  CHECK(answer("602#4000100000000000") == "582#4300100092010200");  // the other node
  CHECK(answer("601#40001000000000").empty());                      // seven bytes are no SDO
}

TEST_CASE("The master's heartbeat is watched from the first that was heard", "[node]") {
  EasyRobot robot;
  // 0x1016:1 = node 127, 100 ms
  CHECK(robot.send("601#2316100164007F00") == Lines{"581#6016100100000000"});
  CHECK(robot.wait(1000).empty());
  robot.send("000#0101");
  robot.send("77F#05");
  robot.wait(60);
  robot.send("77E#05");  // somebody else
  robot.send("77F#05");
  CHECK(robot.wait(99).empty());
  SECTION("lost: an emergency message, 0x8130, generic and communication; by default back to pre-operational") {
    CHECK(robot.wait(1) == Lines{"081#3081110000000000"});
    CHECK(robot.slaves.slave(1)->state() == canopen::NmtState::pre_operational);
    CHECK(robot.value(1, 0x1001) == 0x11);
    CHECK(robot.wait(1000).empty());
    CHECK(robot.send("77F#05") == Lines{"081#0000000000000000"});
    CHECK(robot.value(1, 0x1001) == 0);
  }
  SECTION("lost, with communication error behaviour 1: it stays operational") {
    robot.write(1, 0x1029, 1, 1, 1);
    robot.wait(1);
    CHECK(robot.slaves.slave(1)->state() == canopen::NmtState::operational);
  }
  SECTION("a new time ends the watch until the next heartbeat") {
    robot.write(1, 0x1016, 1, 4, 0x7f0032);
    CHECK(robot.wait(1000).empty());
    robot.send("77F#05");
    CHECK(robot.wait(49).empty());
    CHECK(robot.wait(1).size() == 1);
  }
}

TEST_CASE("A node with the fault \"no heartbeat watch\" does not miss its master", "[node]") {
  EasyRobot robot;
  robot.send("601#2316100164007F00");
  robot.send("77F#05");
  robot.inject({FaultKind::no_heartbeat, 1});
  CHECK(robot.wait(1000).empty());
  robot.send("77F#05");
  CHECK(robot.wait(1000).empty());
  robot.inject({FaultKind::healed, 1});
  robot.send("77F#05");
  CHECK(robot.wait(100).size() == 1);
}
