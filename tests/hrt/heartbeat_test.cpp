// libkenaf_real: which frames are heartbeats, who is missed, and what an absent bus is called.
#include <linux/can/error.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>
#include <catch2/catch.hpp>

#include <array>
#include <chrono>
#include <cstring>

#include "hrt/config.hpp"
#include "hrt/error.hpp"
#include "libkenaf_real/can_socket.hpp"
#include "libkenaf_real/can_transport.hpp"
#include "libkenaf_real/heartbeat.hpp"

using namespace kenaf;
using namespace kenaf::real;
using namespace std::chrono_literals;

namespace {

can_frame frame_of(canid_t id, std::initializer_list<std::uint8_t> data) {
  can_frame frame{};
  frame.can_id = id;
  frame.can_dlc = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), frame.data);
  return frame;
}

// Two ends of a bus: frames written to one are read from the other, whole.
struct Wire {
  Wire() { REQUIRE(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, end.data()) == 0); }
  ~Wire() {
    for (const int descriptor : {end[0], end[1], interrupt}) ::close(descriptor);
  }
  void put(const can_frame& frame) { REQUIRE(write(end[0], &frame, sizeof frame) == sizeof frame); }
  std::array<int, 2> end{};
  int interrupt = eventfd(0, EFD_CLOEXEC);
};

}  // namespace

TEST_CASE("a heartbeat is one byte on 0x700 + node: CiA 301") {
  const auto boot = heartbeat_from(frame_of(0x701, {0x00}));
  REQUIRE(boot);
  CHECK(boot->node == 1);
  CHECK(boot->state == NmtState::boot_up);
  CHECK(heartbeat_from(frame_of(0x77f, {0x05}))->node == 127);
  CHECK(heartbeat_from(frame_of(0x705, {0x7f}))->state == NmtState::pre_operational);
  CHECK(heartbeat_from(frame_of(0x705, {0x04}))->state == NmtState::stopped);
}

TEST_CASE("what is no heartbeat is not taken for one") {
  CHECK_FALSE(heartbeat_from(frame_of(0x700, {0x05})));  // node 0 does not exist
  CHECK_FALSE(heartbeat_from(frame_of(0x780, {0x05})));
  CHECK_FALSE(heartbeat_from(frame_of(0x181, {0x05})));  // a process data object
  CHECK_FALSE(heartbeat_from(frame_of(0x701, {})));
  CHECK_FALSE(heartbeat_from(frame_of(0x701, {0x05, 0x00})));
  CHECK_FALSE(heartbeat_from(frame_of(0x701, {0x85})));                 // node guarding's toggle bit
  CHECK_FALSE(heartbeat_from(frame_of(0x701 | CAN_EFF_FLAG, {0x05})));  // extended identifier
  CHECK_FALSE(heartbeat_from(frame_of(0x701 | CAN_RTR_FLAG, {0x05})));  // remote request
  CHECK_FALSE(heartbeat_from(frame_of(0x701 | CAN_ERR_FLAG, {0x05})));
}

TEST_CASE("a filter lets through exactly its node's heartbeat") {
  const std::array<std::uint8_t, 2> nodes{3, 127};
  const auto filters = heartbeat_filters(nodes);
  REQUIRE(filters.size() == 2);
  const auto passes = [&](canid_t id) {
    return (id & filters[0].can_mask) == (filters[0].can_id & filters[0].can_mask);
  };
  CHECK(passes(0x703));
  CHECK_FALSE(passes(0x704));
  CHECK_FALSE(passes(0x603));
  CHECK_FALSE(passes(0x703 | CAN_EFF_FLAG));
  CHECK_FALSE(passes(0x703 | CAN_RTR_FLAG));
}

TEST_CASE("listening ends once everybody was heard") {
  Wire wire;
  const std::array<std::uint8_t, 2> nodes{1, 2};
  wire.put(frame_of(0x702, {0x7f}));
  wire.put(frame_of(0x705, {0x05}));
  wire.put(frame_of(0x701, {0x05}));
  const NodesHeard heard = listen_for(nodes, wire.end[1], wire.interrupt, 20s);
  CHECK(heard.state.at(1) == NmtState::operational);
  CHECK(heard.state.at(2) == NmtState::pre_operational);
  CHECK(heard.bus_error.empty());
}

TEST_CASE("listening ends with the patience, and says what the bus reported") {
  Wire wire;
  const std::array<std::uint8_t, 2> nodes{1, 2};
  wire.put(frame_of(0x702, {0x05}));
  wire.put(frame_of(CAN_ERR_FLAG | CAN_ERR_ACK, {0, 0, 0, 0, 0, 0, 0, 0}));
  const NodesHeard heard = listen_for(nodes, wire.end[1], wire.interrupt, 50ms);
  CHECK_FALSE(heard.state.contains(1));
  CHECK(heard.state.contains(2));
  CHECK(heard.bus_error == "no acknowledgement: is anybody else on the bus?");
}

TEST_CASE("an interrupt ends listening") {
  Wire wire;
  const std::uint64_t one = 1;
  REQUIRE(write(wire.interrupt, &one, sizeof one) == sizeof one);
  const std::array<std::uint8_t, 1> nodes{1};
  CHECK(listen_for(nodes, wire.end[1], wire.interrupt, 20s).state.empty());
}

TEST_CASE("a bus that cannot be had is a device error that names the way out") {
  hrt_config config = hrt::default_config();
  std::strcpy(config.can_interface, "nocan7");
  CanTransport transport;
  try {
    transport.open(config);
    FAIL("there is no interface nocan7");
  } catch (const hrt::Error& error) {
    CHECK(error.code() == HRT_E_DEVICE);
    // Which of them depends on the kernel that this runs on.
    CHECK_THAT(error.what(), Catch::Contains("modprobe can") || Catch::Contains("no network interface 'nocan7'"));
  }
}
