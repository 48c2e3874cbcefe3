// Node guarding (CiA 301, 7.2.8.3.2.1): a remote frame asks, the answer is the state with a toggle bit, bit 7.
#include <catch2/catch.hpp>

#include "can/canlog/describe.hpp"
#include "tests/can/canlog/lines.hpp"

using namespace kenaf;
using namespace kenaf::canlog;

TEST_CASE("Requests of node guarding and alternating answers break no rule") {
  // 0x7f pre-operational, 0xff the same with bit 7; 0x05 operational, 0x85 the same with bit 7
  CHECK(broken({{0, "701#R"},
                {1, "701#7F"},
                {1000, "701#R"},
                {1001, "701#FF"},
                {2000, "000#0101"},
                {2100, "701#R1"},
                {2101, "701#05"},
                {3100, "701#R"},
                {3101, "701#85"}})
            .empty());
}

TEST_CASE("A toggle bit that does not alternate is a finding") {
  CHECK(broken({{0, "701#R"}, {1, "701#7F"}, {1000, "701#R"}, {1001, "701#7F"}}) == Broken{"4: node-guarding"});
  CHECK(broken({{0, "701#R"}, {1, "701#FF"}, {1000, "701#R"}, {1001, "701#FF"}}) == Broken{"4: node-guarding"});
  // each node has its own; a request without an answer changes nothing
  CHECK(broken({{0, "701#R"}, {1, "701#7F"}, {2, "702#R"}, {3, "702#7F"}, {4, "701#R"}, {5, "701#R"}, {6, "701#FF"}})
            .empty());
}

TEST_CASE("The first answer after a reset has the toggle bit 0") {
  CHECK(broken({{0, "701#00"}, {100, "701#R"}, {101, "701#7F"}}).empty());
  CHECK(broken({{0, "701#00"}, {100, "701#R"}, {101, "701#FF"}}) == Broken{"3: node-guarding"});
  CHECK(
      broken({{0, "701#R"}, {1, "701#7F"}, {10, "000#8201"}, {60, "701#00"}, {100, "701#R"}, {101, "701#7F"}}).empty());
  // before the log the bit may have been either
  CHECK(broken({{100, "701#R"}, {101, "701#FF"}}).empty());
}

TEST_CASE("Heartbeats are no answers, and a log may lack the requests") {
  CHECK(broken({{0, "701#7F"}, {1000, "701#7F"}}).empty());
  CHECK(broken({{0, "701#7F"}, {1000, "701#FF"}, {2000, "701#7F"}, {3000, "701#FF"}}).empty());
  CHECK(broken({{0, "701#FF"}, {1000, "701#FF"}}) == Broken{"2: node-guarding"});
  // 0x80 would be boot-up with the bit, and 0x86 a state that does not exist
  CHECK(broken({{0, "701#80"}, {1000, "701#86"}}) == Broken{"1: content", "2: content"});
}

TEST_CASE("A guarded node's state is known from its answers") {
  CHECK(broken({{0, "701#R"}, {1, "701#FF"}, {20, "181#370200000000"}}) == Broken{"3: nmt-state"});
}

TEST_CASE("A remote frame may ask for a PDO, and for nothing else but guarding") {
  CHECK(broken({{0, "181#R6"}}).empty());
  CHECK(broken({{0, "201#R6"}, {1, "601#R8"}, {2, "709#R"}}) ==
        Broken{"1: identifier", "2: identifier", "3: identifier"});
  // bit 30 of the identifier of TPDO1 forbids it
  CHECK(broken({{0, "601#2300180181010040"}, {1, "581#6000180100000000"}, {2, "181#R6"}}) == Broken{"3: identifier"});
}

TEST_CASE("Node guarding is put in words") {
  CHECK(words_of({{0, "701#R"}, {1, "701#7F"}, {2, "701#R"}, {3, "701#FF"}, {4, "701#7F"}, {5, "181#R6"}}) ==
        std::vector<std::string>{
            "track left: node guarding, request", "track left: node guarding, pre-operational, toggle bit 0",
            "track left: node guarding, request", "track left: node guarding, pre-operational, toggle bit 1",
            "track left: heartbeat, pre-operational", "track left: request of TPDO1"});
}
