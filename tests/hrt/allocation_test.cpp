// No cycle of the library allocates, while the program drives, turns, waits and records. A program of its own, because
// it counts every call of the heap of the thread of the cycles; those of the fake robot are made outside what is
// counted.
#include <atomic>
#include <catch2/catch.hpp>

#include "hrt/robot.hpp"
#include "kenaf/hrt.h"
#include "tests/hrt/fake_transport.hpp"
#include "tests/support/heap_calls.hpp"
#include "tests/support/process.hpp"

using namespace kenaf::hrt;
using kenaf::test::heap_calls;

namespace {

// Counts what the thread of the cycles asks of the heap from the return of wait_state to the call of send.
class CountedTransport final : public Transport {
 public:
  CountedTransport(std::shared_ptr<test::FakeRobot> robot, std::atomic<long>& counted)
      : robot_(std::move(robot)), counted_(counted) {}
  Connection open(const hrt_config& config) override { return robot_.open(config); }
  std::optional<kenaf::robot::State> wait_state() override {
    std::optional<kenaf::robot::State> state = robot_.wait_state();
    before_ = heap_calls();
    return state;
  }
  void send(const kenaf::robot::Command& command) override {
    if (begun_) counted_ += heap_calls() - before_;
    begun_ = true;  // the first state came to the thread that opened
    robot_.send(command);
  }
  void interrupt() override { robot_.interrupt(); }
  void close() override { robot_.close(); }
  const std::string& warning() const override { return warning_; }
  double round_trip_s() const override { return 0; }
  bool is_paused() const override { return false; }

 private:
  test::FakeTransport robot_;
  std::string warning_ = "the gyro is silent: no posture, and the heading is that of the tracks";
  std::atomic<long>& counted_;
  long before_ = 0;
  bool begun_ = false;
};

}  // namespace

TEST_CASE("No cycle allocates, whatever the program does") {
  const kenaf::support::TemporaryFolder folder;
  for (const bool lockstep : {false, true}) {
    auto fake = std::make_shared<test::FakeRobot>();
    fake->lockstep = lockstep;
    std::atomic<long> counted = 0;
    Robot robot(std::make_unique<CountedTransport>(fake, counted), hrt_config_default());
    robot.record_start((folder.path() / "run.csv").string());
    robot.set_tracks(0.1, 0.1);
    robot.sleep(0.2);
    robot.go_forward(0.1);
    robot.turn(0.5);
    robot.set_flippers(0xf, {0.5, 0.5, 0.5, 0.5});
    robot.wait_flippers(0.01, 10);
    robot.sleep(0.5);
    robot.record_stop();
    robot.close();
    CAPTURE(lockstep);
    CHECK(counted == 0);
    CHECK(fake->commands.size() > 100);
  }
}
