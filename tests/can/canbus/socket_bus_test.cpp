// What can be said of a SocketCAN bus without one; tests/can/kernel_bus has it on a bus.
#include <linux/can.h>
#include <linux/can/error.h>
#include <catch2/catch.hpp>

#include "can/canbus/socket_bus.hpp"

using namespace kenaf::canbus;

TEST_CASE("A bus that cannot be had says what to do") {
  // Which of them depends on the kernel that this runs on.
  CHECK_THROWS_WITH(SocketBus("nocan7"),
                    Catch::Contains("modprobe can") || Catch::Contains("there is no network interface 'nocan7'"));
}

TEST_CASE("Every error frame has words, the worst first") {
  CHECK(describe_error_frame(CAN_ERR_FLAG | CAN_ERR_BUSOFF | CAN_ERR_ACK) ==
        "bus off: too many errors; is the bit rate right?");
  CHECK(describe_error_frame(CAN_ERR_FLAG | CAN_ERR_ACK) == "no acknowledgement: is any other node on the bus?");
  CHECK(describe_error_frame(CAN_ERR_FLAG) == "unknown error");
}
