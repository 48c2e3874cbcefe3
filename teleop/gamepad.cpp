#include "gamepad.hpp"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <utility>

namespace kenaf::teleop {

namespace {

constexpr double kFullStick = 32767;
constexpr double kRest = 0.12;  // a released stick may rest this far from its centre
constexpr int kDevices = 8;
constexpr double kCrossPeriod_s = 0.05;  // a held cross repeats like a key

enum Axis : unsigned { kLeftStickY = 1, kRightStickX = 3, kCrossX = 6, kCrossY = 7 };
constexpr unsigned kEmergencyButton = 1, kDeadmanButton = 4;

constexpr auto kButtons = std::to_array<std::pair<unsigned, Action>>({
    {0, Action::posture_2},                      // A
    {kEmergencyButton, Action::emergency_stop},  // B
    {2, Action::posture_3},                      // X
    {3, Action::posture_4},                      // Y
    {5, Action::faster},                         // RB
    {6, Action::slower},                         // back
    {7, Action::release_emergency},              // start
    {10, Action::posture_5},                     // right stick
});

// 0 within kRest, then rising continuously to 1.
double deflection(int value) {
  const double share = std::clamp(value / kFullStick, -1.0, 1.0);
  return std::copysign(std::max(0.0, (std::abs(share) - kRest) / (1 - kRest)), share);
}

std::optional<Action> action_of_cross(unsigned axis, int value) {
  if (value == 0) return std::nullopt;
  if (axis == kCrossY) return value < 0 ? Action::front_up : Action::front_down;  // the kernel's y points down
  return value > 0 ? Action::rear_up : Action::rear_down;
}

}  // namespace

std::optional<Action> GamepadState::take(const js_event& event) {
  // Positions reported when the device is opened, and again after the kernel had to drop events: releases count,
  // presses only if they stop the robot.
  const bool is_initial = (event.type & JS_EVENT_INIT) != 0;
  const int type = event.type & ~JS_EVENT_INIT;
  if (type == JS_EVENT_AXIS) {
    if (event.number == kLeftStickY) sticks_.forward = -deflection(event.value);
    if (event.number == kRightStickX) sticks_.turn = -deflection(event.value);
    const bool is_cross = event.number == kCrossX || event.number == kCrossY;
    if (is_cross && (!is_initial || event.value == 0)) cross_ = action_of_cross(event.number, event.value);
    return std::nullopt;
  }
  if (type != JS_EVENT_BUTTON) return std::nullopt;
  if (event.number == kDeadmanButton && (!is_initial || event.value == 0)) sticks_.deadman = event.value != 0;
  if (event.value == 0 || (is_initial && event.number != kEmergencyButton)) return std::nullopt;
  const auto found = std::ranges::find(kButtons, unsigned{event.number}, &std::pair<unsigned, Action>::first);
  return found == kButtons.end() ? std::nullopt : std::optional(found->second);
}

// A press is an event, so nothing that is held tells of itself again.
void GamepadState::let_go() {
  sticks_.deadman = false;
  cross_.reset();
}

Gamepad::Gamepad(std::string path) : path_(std::move(path)) {}

Gamepad::~Gamepad() {
  close();
}

void Gamepad::open() {
  const auto try_path = [&](const std::string& path) {
    descriptor_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor_ < 0) return false;
    std::array<char, 64> name{};
    const bool has_name =
        ::ioctl(descriptor_, static_cast<unsigned long>(JSIOCGNAME(name.size() - 1)), name.data()) >= 0;
    name_ = has_name ? name.data() : path.c_str();
    return true;
  };
  if (!path_.empty()) {
    (void)try_path(path_);
    return;
  }
  for (int i = 0; i < kDevices; ++i) {
    if (try_path("/dev/input/js" + std::to_string(i))) return;
  }
}

void Gamepad::close() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  name_.clear();
  state_ = {};
}

std::vector<Action> Gamepad::read(double now_s) {
  std::vector<Action> actions;
  if (path_ == "none") return actions;
  if (descriptor_ < 0 && now_s >= look_again_s_) {
    look_again_s_ = now_s + 1;
    open();
  }
  while (descriptor_ >= 0) {
    js_event event{};
    const ssize_t got = ::read(descriptor_, &event, sizeof event);
    if (got == sizeof event) {
      if (const auto action = state_.take(event)) actions.push_back(*action);
    } else if (got < 0 && (errno == EAGAIN || errno == EINTR)) {
      break;
    } else {
      close();  // unplugged, or not a gamepad
      look_again_s_ = now_s + 1;
    }
  }
  if (!state_.cross()) cross_again_s_ = now_s;
  if (state_.cross() && now_s >= cross_again_s_) {
    actions.push_back(*state_.cross());
    cross_again_s_ = now_s + kCrossPeriod_s;
  }
  return actions;
}

}  // namespace kenaf::teleop
