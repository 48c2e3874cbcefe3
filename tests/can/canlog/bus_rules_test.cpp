// The rules of the bus as a whole: for each a log that keeps it and one that breaks it.
#include <catch2/catch.hpp>

#include "tests/can/canlog/lines.hpp"

using namespace kenaf;
using namespace kenaf::canlog;

TEST_CASE("Identifiers: those of the predefined connection set, of nodes and PDOs that there are") {
  CHECK(broken({{0, "000#0101"},
                {1, "080#"},
                {2, "081#0000000000000000"},
                {3, "100#000000000000"},
                {4, "77F#05"},
                {5, "701#05"}})
            .empty());
  // 0x780: nobody's; 0x709: node 9 is not on this robot; 0x401: RPDO3 of a drive that has none
  CHECK(broken({{0, "780#00"}, {1, "709#05"}, {2, "401#00"}}) ==
        Broken{"1: identifier", "2: identifier", "3: identifier"});
  CHECK(broken({{0, "780#00"}, {1, "780#00"}}) == Broken{"1: identifier"});
  CHECK(broken({{0, "00000181#00"}, {1, "601#R8"}, {2, "181##000"}}) ==
        Broken{"1: identifier", "2: identifier", "3: identifier"});
  CHECK(broken({{0, "20000004#000C000000000000"}}).empty());  // of the driver, not of the bus
}

TEST_CASE("Devices of others that the description names are known, by their names") {
  canbus::RobotBus bus = candrives::easy_robot();
  bus.others.push_back({"battery monitor", 9, 0});
  const Network network(bus);
  // a heartbeat, a PDO that nobody here has set up, and an answer to its own master
  const Log log = log_of({{0, "709#05"}, {1, "189#0102"}, {2, "289#01"}});
  CHECK(check_rules(log, network).empty());
  CHECK_THAT(Describer(network).describe(log.frames[0]), Catch::Contains("battery monitor"));
}

TEST_CASE("Lengths: each service has its own") {
  CHECK(broken({{0, "080#"}, {1, "080#01"}, {2, "181#370200000000"}, {3, "283#0000"}, {4, "187#00000000"}}).empty());
  CHECK(broken({{0, "000#01"},
                {1, "080#0102"},
                {2, "701#0500"},
                {3, "601#40416000000000"},
                {4, "081#00"},
                {5, "181#3702000000"},
                {6, "201#0F00000000000000"},
                {7, "100#00"}}) ==
        Broken{"1: length", "2: length", "3: length", "4: length", "5: length", "6: length", "7: length", "8: length"});
  // the gyro's rate ends with bit 32; what comes behind is its maker's
  CHECK(broken({{0, "188#00000000"}, {1, "188#0000000000000000"}}).empty());
  CHECK(broken({{0, "188#000000"}}) == Broken{"1: length"});
}

TEST_CASE("Content: orders and states that NMT has") {
  CHECK(broken({{0, "000#8001"}, {1, "701#7F"}}).empty());
  CHECK(broken({{0, "000#0301"}, {1, "701#06"}}) == Broken{"1: content", "2: content"});
}

TEST_CASE("After a reset a node says boot-up first") {
  CHECK(broken({{0, "000#8201"}, {20, "701#00"}, {30, "701#7F"}}).empty());
  CHECK(broken({{0, "000#8100"}, {20, "081#0000000000000000"}}) == Broken{"2: boot-up"});
  // it was on its way when the order came
  CHECK(broken({{0, "000#8201"}, {0.5, "181#370200000000"}, {20, "701#00"}}).empty());
  CHECK(broken({{0, "000#8201"}, {20, "181#370200000000"}, {30, "701#00"}}) == Broken{"2: boot-up"});
  CHECK(broken({{0, "000#8201"}, {60, "701#05"}, {61, "701#05"}, {70, "701#00"}}) == Broken{"2: boot-up"});
  // of a log that begins later nobody knows whether there was a reset
  CHECK(broken({{0, "701#05"}}).empty());
}

TEST_CASE("PDOs come from and go to operational nodes alone") {
  const Lines start{{0, "701#00"}, {10, "000#0101"}};
  CHECK(broken(start + Lines{{20, "181#370200000000"}, {21, "201#000000000000"}}).empty());
  CHECK(broken({{0, "701#00"}, {20, "181#370200000000"}}) == Broken{"2: nmt-state"});
  CHECK(broken({{0, "701#00"}, {20, "201#000000000000"}}) == Broken{"2: nmt-state"});
  CHECK(broken(start + Lines{{20, "000#8000"}, {30, "181#370200000000"}}) == Broken{"4: nmt-state"});
  // a heartbeat tells, too; one that waited longer than the order needed does not
  CHECK(broken({{0, "701#7F"}, {20, "181#370200000000"}}) == Broken{"2: nmt-state"});
  CHECK(broken(start + Lines{{12, "701#7F"}, {20, "181#370200000000"}}).empty());
  CHECK(broken(start + Lines{{80, "701#7F"}, {90, "181#370200000000"}}) == Broken{"4: nmt-state"});
  CHECK(broken({{20, "181#370200000000"}}).empty());
}

TEST_CASE("A stopped node has heartbeats and NMT, and nothing else") {
  const Lines stop{{0, "701#05"}, {10, "000#0201"}};
  CHECK(broken(stop + Lines{{20, "701#04"}, {30, "000#8001"}, {40, "081#0000000000000000"}}).empty());
  CHECK(broken(stop + Lines{{20, "081#0000000000000000"}}) == Broken{"3: nmt-state"});
  CHECK(broken(stop + Lines{{20, "601#8000000000000000"}}) == Broken{"3: nmt-state"});
}

namespace {

// 0x1016:1 of node 1: node 127 for 100 ms (0x007f0064)
const Lines kWatch{{0, "601#2316100164007F00"}, {1, "581#6016100100000000"}};

}  // namespace

TEST_CASE("The master's heartbeat comes as often as its consumers ask for") {
  CHECK(broken(kWatch + Lines{{300, "77F#05"}, {400, "77F#05"}, {500, "77F#05"}}).empty());
  // before the watch the time between two does not count; the line of the last before the gap is named
  CHECK(broken({{0, "77F#05"}, {300, "77F#05"}}).empty());
  CHECK(broken(kWatch + Lines{{300, "77F#05"}, {401, "77F#05"}}) == Broken{"3: master-heartbeat"});
  CHECK(broken(kWatch + Lines{{300, "77F#05"}, {401, "080#"}, {900, "080#"}}) == Broken{"3: master-heartbeat"});
  // the watch ends with a 0, or with a reset
  const Lines end{{380, "601#2316100100000000"}, {381, "581#6016100100000000"}, {900, "080#"}};
  CHECK(broken(kWatch + Lines{{300, "77F#05"}} + end).empty());
  CHECK(broken(kWatch + Lines{{300, "77F#05"}, {350, "000#8201"}, {900, "080#"}}).empty());
  // what the node has refused is not watched for
  CHECK(broken({{0, "601#2316100164007F00"}, {1, "581#8016100130000906"}, {2, "77F#05"}, {400, "77F#05"}}).empty());
}
