#include <catch2/catch.hpp>
#include <initializer_list>

#include "can/canopen/nmt.hpp"
#include "tests/can/canopen/frames.hpp"

using namespace kenaf::canopen;

TEST_CASE("NMT orders are two bytes on identifier 0: command and node") {
  // CiA 301, 7.2.8.3.1: start 1, stop 2, enter pre-operational 128, reset node 129, reset communication 130.
  CHECK(encode(NmtOrder{NmtCommand::start, 5}) == frame_of(0x000, {0x01, 0x05}));
  CHECK(encode(NmtOrder{NmtCommand::stop, 5}) == frame_of(0x000, {0x02, 0x05}));
  CHECK(encode(NmtOrder{NmtCommand::enter_pre_operational, 127}) == frame_of(0x000, {0x80, 0x7f}));
  CHECK(encode(NmtOrder{NmtCommand::reset_node, 0}) == frame_of(0x000, {0x81, 0x00}));  // 0: all nodes
  CHECK(encode(NmtOrder{NmtCommand::reset_communication, 1}) == frame_of(0x000, {0x82, 0x01}));
}

TEST_CASE("NMT orders are read") {
  const auto order = nmt_order_from(frame_of(0x000, {0x82, 0x7f}));
  REQUIRE(order);
  CHECK(order->command == NmtCommand::reset_communication);
  CHECK(order->node == 127);
  REQUIRE(nmt_order_from(frame_of(0x000, {0x01, 0x00})));
  CHECK(nmt_order_from(frame_of(0x000, {0x01, 0x00}))->node == 0);
}

TEST_CASE("What is no NMT order is none") {
  CHECK_FALSE(nmt_order_from(frame_of(0x001, {0x01, 0x05})));        // another identifier
  CHECK_FALSE(nmt_order_from(frame_of(0x000, {0x01})));              // one byte
  CHECK_FALSE(nmt_order_from(frame_of(0x000, {0x01, 0x05, 0x00})));  // three
  CHECK_FALSE(nmt_order_from(frame_of(0x000, {0x01, 0x80})));        // node 128
  for (const std::uint8_t command : std::initializer_list<std::uint8_t>{0x00, 0x03, 0x7f, 0x83, 0xff})
    CHECK_FALSE(nmt_order_from(frame_of(0x000, {command, 0x05})));
}

TEST_CASE("Heartbeats are one byte, the state, on 0x700 and the node") {
  // CiA 301, 7.2.8.3.2.2: boot-up 0, stopped 4, operational 5, pre-operational 127.
  CHECK(encode(Heartbeat{1, NmtState::boot_up}) == frame_of(0x701, {0x00}));
  CHECK(encode(Heartbeat{2, NmtState::stopped}) == frame_of(0x702, {0x04}));
  CHECK(encode(Heartbeat{3, NmtState::operational}) == frame_of(0x703, {0x05}));
  CHECK(encode(Heartbeat{127, NmtState::pre_operational}) == frame_of(0x77f, {0x7f}));
}

TEST_CASE("Heartbeats are read") {
  const auto operational = heartbeat_from(frame_of(0x77f, {0x05}));
  REQUIRE(operational);
  CHECK(operational->node == 127);
  CHECK(operational->state == NmtState::operational);
  REQUIRE(heartbeat_from(frame_of(0x701, {0x00})));
  CHECK(heartbeat_from(frame_of(0x701, {0x00}))->state == NmtState::boot_up);
}

TEST_CASE("What is no heartbeat is none") {
  CHECK_FALSE(heartbeat_from(frame_of(0x700, {0x05})));  // node 0
  CHECK_FALSE(heartbeat_from(frame_of(0x780, {0x05})));  // node 128
  CHECK_FALSE(heartbeat_from(frame_of(0x6ff, {0x05})));
  CHECK_FALSE(heartbeat_from(frame_of(0x701, {})));
  CHECK_FALSE(heartbeat_from(frame_of(0x701, {0x05, 0x00})));
  CHECK_FALSE(heartbeat_from(frame_of(0x701, {0x85})));  // node guarding's toggle bit
  CHECK_FALSE(heartbeat_from(frame_of(0x701, {0x01})));  // no state of CiA 301
}

TEST_CASE("A SYNC is identifier 0x80 with no byte, or with one of a counter") {
  CHECK(kSync == frame_of(0x080, {}));
  CHECK(is_sync(kSync));
  CHECK(is_sync(frame_of(0x080, {0x07})));
  CHECK_FALSE(is_sync(frame_of(0x080, {0x07, 0x00})));
  CHECK_FALSE(is_sync(frame_of(0x081, {})));
}

TEST_CASE("Identifiers of the predefined connection set") {
  // CiA 301, 7.3.5: function code in bits 7 to 10, node in bits 0 to 6.
  CHECK(kTransmitPdoId[0] == 3 << 7);
  CHECK(kReceivePdoId[0] == 4 << 7);
  CHECK(kTransmitPdoId[3] == 9 << 7);
  CHECK(kReceivePdoId[3] == 10 << 7);
  CHECK(kSdoResponseId == 11 << 7);
  CHECK(kSdoRequestId == 12 << 7);
  CHECK(kHeartbeatId == 14 << 7);
}

TEST_CASE("NMT states are put in words") {
  CHECK(describe(NmtState::boot_up) == "boot-up");
  CHECK(describe(NmtState::stopped) == "stopped");
  CHECK(describe(NmtState::operational) == "operational");
  CHECK(describe(NmtState::pre_operational) == "pre-operational");
}
