// A bus on which nobody is powered yet: no frame is acknowledged, and the interface's queue is full after a few.
#include <catch2/catch.hpp>

#include "hrt/error.hpp"
#include "tests/libkenaf_real/robot_on_bus.hpp"

using namespace kenaf;
using namespace kenaf::real;

namespace {

// Takes nothing until `dead_until`: each frame is waited with for 20 ms, as canbus::SocketBus does.
class DeadBus final : public canopen::Bus {
 public:
  DeadBus(candrives::SimulatedBus& wire, canopen::Time dead_until) : wire_(wire), dead_until_(dead_until) {}
  canopen::Time now() const override { return wire_.now(); }
  void send(const canopen::Frame& frame) override {
    if (now() < dead_until_) {
      wire_.hold_up_until(now() + std::chrono::milliseconds(20));
      throw canopen::BusFull("CAN interface 'can0' accepts no more frames: no node acknowledges them");
    }
    wire_.send(frame);
  }
  std::optional<canopen::ReceivedFrame> receive(canopen::Time until) override { return wire_.receive(until); }
  void start_sync(canopen::Time period) override { wire_.start_sync(period); }
  void stop_sync() override { wire_.stop_sync(); }
  void interrupt() override { wire_.interrupt(); }

 private:
  candrives::SimulatedBus& wire_;
  canopen::Time dead_until_;
};

}  // namespace

TEST_CASE("A robot that is switched on while it is opened is waited for") {
  RobotOnBus robot;
  CanTransport transport([&](const std::string&, std::span<const std::uint16_t>) {
    return std::make_unique<DeadBus>(robot.wire, std::chrono::seconds(2));
  });
  transport.open(robot.config);
  CHECK(robot.all_are(canopen::PowerState::operation_enabled));
}

TEST_CASE("A robot that is not switched on is named, and what the bus says, after can_timeout_s") {
  RobotOnBus robot;
  robot.config.can_timeout_s = 3;
  CanTransport transport([&](const std::string&, std::span<const std::uint16_t>) {
    return std::make_unique<DeadBus>(robot.wire, std::chrono::seconds(60));
  });
  try {
    transport.open(robot.config);
    FAIL("it opened");
  } catch (const hrt::Error& error) {
    CHECK(error.code() == HRT_E_DEVICE);
    CHECK_THAT(error.what(), Catch::Contains("these nodes did not start within 3 s: track left (node 1)") &&
                                 Catch::Contains("gyro (node 8)") && Catch::Contains("no node acknowledges them"));
  }
  CHECK(robot.seconds() == Approx(0.1 + 3).margin(0.05));  // after listening for another master
}
