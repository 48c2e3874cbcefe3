#include "tests/hrt/fake_transport.hpp"

#include <chrono>
#include <thread>

#include "hrt/error.hpp"
#include "robot/state.hpp"

namespace kenaf::hrt {
namespace {

std::function<std::unique_ptr<Transport>()> maker;
std::function<std::unique_ptr<Camera>(const hrt_config&, const std::string&)> camera_maker;

}  // namespace

std::unique_ptr<Transport> make_transport() {
  return maker();
}
std::string resolve_camera(const hrt_config&, const std::string& name) {
  return name;
}
std::unique_ptr<Camera> make_camera(const hrt_config& config, const std::string& camera) {
  return camera_maker(config, camera);
}
extern const char* const kLibraryName = "sim";

namespace test {

void use_transport(std::function<std::unique_ptr<Transport>()> make) {
  maker = std::move(make);
}

void use_cameras(std::function<std::unique_ptr<Camera>(const hrt_config&, const std::string&)> make) {
  camera_maker = std::move(make);
}

std::shared_ptr<FakeRobot> use_fake_robot(const PlantSettings& settings) {
  auto robot = std::make_shared<FakeRobot>();
  robot->plant = Plant(settings);
  use_transport([robot] { return std::make_unique<FakeTransport>(robot); });
  return robot;
}

Connection FakeTransport::open(const hrt_config&) {
  const std::lock_guard lock(robot_->mutex);
  robot_->interrupted = robot_->closed = false;
  return {robot_->plant.settings.period_s, robot_->lockstep};
}

std::optional<robot::State> FakeTransport::wait_state() {
  std::unique_lock lock(robot_->mutex);
  if (!first_ && !answered_) {
    const auto may_go_on = [&] { return robot_->interrupted || answered_; };
    if (robot_->runs_alone)
      robot_->changed.wait_for(lock, std::chrono::milliseconds(1), may_go_on);
    else
      robot_->changed.wait(lock, may_go_on);
  }
  robot_->changed.wait(lock, [&] {
    return robot_->interrupted || robot_->paused_after == 0 || robot_->plant.state.frame < robot_->paused_after;
  });
  if (robot_->interrupted && (!answered_ || robot_->late_interrupts-- <= 0)) return std::nullopt;
  if (first_) {
    first_ = false;
    robot_->travel_m.push_back(robot_->plant.state.track_m[0]);
    return robot_->plant.state;
  }
  // A program that does not call lets time run on: not faster than a test can watch.
  lock.unlock();
  std::this_thread::sleep_for(std::chrono::microseconds(20));
  lock.lock();
  do {
    robot_->travel_m.push_back(robot_->plant.advance(command_).track_m[0]);
  } while (robot_->plant.state.frame == robot_->skipped_frame);
  answered_ = false;
  if (robot_->reset_at_frame != 0 && robot_->plant.state.frame == robot_->reset_at_frame) robot_->plant.restart();
  if (robot_->reset_at_frame != 0 && robot_->plant.state.frame >= robot_->reset_at_frame) {
    robot_->plant.state.robot_time_s -= robot_->reset_at_frame * robot_->plant.settings.period_s;
  }
  if (robot_->lost_at_frame != 0 && robot_->plant.state.frame >= robot_->lost_at_frame) {
    throw Error(HRT_E_LINK, "the fake link broke");
  }
  return robot_->plant.state;
}

void FakeTransport::send(const robot::Command& command) {
  const std::lock_guard lock(robot_->mutex);
  command_ = command;
  answered_ = true;
  robot_->commands.push_back(command);
}

void FakeTransport::prepare_cycles(std::thread::native_handle_type) {
  if (!robot_->prepare_error.empty()) throw Error(HRT_E_CONFIG, robot_->prepare_error);
}

void FakeTransport::begin_cycles() {
  if (!robot_->cycles_error.empty()) throw Error(HRT_E_CONFIG, robot_->cycles_error);
}

void FakeTransport::interrupt() {
  const std::lock_guard lock(robot_->mutex);
  robot_->interrupted = true;
  robot_->changed.notify_all();
}

void FakeTransport::close() {
  const std::lock_guard lock(robot_->mutex);
  robot_->closed = true;
  if (!robot_->close_error.empty()) throw Error(HRT_E_DEVICE, robot_->close_error);
}

}  // namespace test
}  // namespace kenaf::hrt
