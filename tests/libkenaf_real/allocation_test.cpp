// No cycle of the real robot allocates: a real-time thread must not wait for a heap that all threads share, nor for
// pages that the system has yet to find. A program of its own, because it counts every call of the heap, of C++ and of
// C; what the simulated bus allocates in the same thread is left out.
#include <catch2/catch.hpp>

#include "tests/libkenaf_real/robot_on_bus.hpp"
#include "tests/support/heap_calls.hpp"

using namespace kenaf;
using namespace kenaf::real;
using kenaf::test::heap_calls;

namespace {

// A bus whose own calls of the heap are counted apart.
class CountedBus final : public canopen::Bus {
 public:
  CountedBus(canopen::Bus& bus, long& own_calls) : bus_(bus), own_calls_(own_calls) {}
  canopen::Time now() const override { return bus_.now(); }
  canopen::Time suspended() override { return bus_.suspended(); }
  void send(const canopen::Frame& frame) override {
    const long before = heap_calls();
    bus_.send(frame);
    own_calls_ += heap_calls() - before;
  }
  std::optional<canopen::ReceivedFrame> receive(canopen::Time until) override {
    const long before = heap_calls();
    std::optional<canopen::ReceivedFrame> frame = bus_.receive(until);
    own_calls_ += heap_calls() - before;
    return frame;
  }
  void start_sync(canopen::Time period) override { bus_.start_sync(period); }
  void stop_sync() override { bus_.stop_sync(); }
  void interrupt() override { bus_.interrupt(); }

 private:
  canopen::Bus& bus_;
  long& own_calls_;
};

}  // namespace

TEST_CASE("No cycle of the real robot allocates, driving, with its flippers, and with a sensor that falls silent") {
  RobotOnBus robot;
  long of_bus = 0;
  CanTransport transport([&](const std::string&, std::span<const std::uint16_t>) {
    robot.wire.open_socket();
    return std::make_unique<CountedBus>(robot.wire, of_bus);
  });
  transport.open(robot.config);
  robot::Command command = drive_at(0.2, -0.1);
  std::size_t warned = 0;
  const auto allocations_in = [&](int cycles) {
    const long before = heap_calls() - of_bus;
    for (int i = 0; i < cycles; ++i) {
      (void)transport.wait_state();
      warned += transport.warning().empty() ? 0 : 1;
      transport.send(command);
    }
    return heap_calls() - of_bus - before;
  };
  CHECK(allocations_in(200) == 0);
  command.flipper[1] = {robot::JointMode::angle, 0.5};
  CHECK(allocations_in(200) == 0);
  CHECK(warned == 0);
  robot.wire.inject({candrives::FaultKind::silent, robot.description.gyro->node});
  CHECK(allocations_in(200) == 0);
  CHECK(warned > 150);
}

TEST_CASE("What is counted is counted") {
  const long before = heap_calls();
  ::operator delete(::operator new(1000));
  CHECK(heap_calls() > before);
}
