// A transport whose robot is a Plant in the same process. Test-only: in these tests it stands where each library has
// its own transport.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "hrt/camera.hpp"
#include "hrt/transport.hpp"
#include "robot/state.hpp"
#include "tests/hrt/plant.hpp"

namespace kenaf::hrt::test {

// What the next hrt_kenaf_init opens, and what happened to it.
struct FakeRobot {
  Plant plant;
  bool lockstep = true;
  std::uint32_t lost_at_frame = 0;   // the link breaks instead of this frame; 0: never
  std::uint32_t skipped_frame = 0;   // this one never arrives; 0: none
  std::uint32_t reset_at_frame = 0;  // the world is reset: its clock begins anew with this one; 0: never
  int late_interrupts = 0;           // so many states are faster than an interrupt
  std::uint32_t paused_after = 0;    // no frame comes after this one; 0: they all do
  bool runs_alone = false;           // not lock step: frames also come without answers, one each millisecond

  std::mutex mutex;
  std::condition_variable changed;
  std::vector<robot::Command> commands;  // commands[i] answers frame i + 1
  std::vector<double> travel_m;          // travel_m[i] is the left track's in frame i + 1
  bool interrupted = false, closed = false;
  std::string cycles_error;   // why its cycles cannot begin; "": they can
  std::string prepare_error;  // why the thread of its cycles cannot be prepared; "": it can
  std::string setup;          // what open found and set up
  std::string close_error;    // what close says of a robot that did not stop; "": it stopped
};

class FakeTransport final : public Transport {
 public:
  explicit FakeTransport(std::shared_ptr<FakeRobot> robot) : robot_(std::move(robot)) {}
  Connection open(const hrt_config& config) override;
  std::optional<robot::State> wait_state() override;
  void send(const robot::Command& command) override;
  void interrupt() override;
  void close() override;
  std::string setup() const override { return robot_->setup; }
  void prepare_cycles(std::thread::native_handle_type thread) override;
  void begin_cycles() override;
  double round_trip_s() const override { return 0.002; }
  bool is_paused() const override { return false; }

 private:
  std::shared_ptr<FakeRobot> robot_;
  bool first_ = true, answered_ = false;
  robot::Command command_;
};

// What make_transport() makes from now on.
void use_transport(std::function<std::unique_ptr<Transport>()> make);
// What make_camera() makes from now on; every name stands for itself.
void use_cameras(std::function<std::unique_ptr<Camera>(const hrt_config& config, const std::string& camera)> make);
// A fresh robot that the next hrt_kenaf_init opens.
std::shared_ptr<FakeRobot> use_fake_robot(const PlantSettings& settings = {});

}  // namespace kenaf::hrt::test
