#include "robot.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

namespace kenaf::teleop {

namespace {

using namespace std::chrono_literals;

std::string words_of(int result) {
  return fmt::format("{}: {}", hrt_error_name(result), hrt_last_error());
}

// A recording may be incomplete, or drives may not have confirmed that they stopped.
void log_close(int result) {
  if (result != HRT_OK) fmt::print(stderr, "operator_control: the robot was closed, but {}\n", words_of(result));
}

// "run.csv" for the first time, then "run-2.csv": losing the robot does not cost the recording so far.
std::string recording(const std::string& path, int times_opened) {
  if (path.empty() || times_opened <= 1) return path;
  const std::filesystem::path first(path);
  return first.parent_path() / fmt::format("{}-{}{}", first.stem().string(), times_opened, first.extension().string());
}

}  // namespace

Robot::Robot(const hrt_config& config) : config_(config), record_(config.record) {
  begin_opening();
}

Robot::~Robot() {
  if (opening_.valid()) opening_.wait();
  log_close(hrt_close());
}

void Robot::begin_opening() {
  hrt_config config = config_;
  if (times_opened_ > 0) config.reset_robot = 0;  // it continues from where it was lost
  std::snprintf(config.record, sizeof config.record, "%s", recording(record_, times_opened_ + 1).c_str());
  if (message_.empty()) message_ = "the robot is being opened";
  opening_ = std::async(std::launch::async, [config] {
    log_close(hrt_close());
    const int result = hrt_kenaf_init_with(&config);
    return Opened{result, result == HRT_OK ? "" : words_of(result)};  // error texts are kept per thread
  });
}

bool Robot::look(hrt_state& state) {
  if (opening_.valid()) {
    if (opening_.wait_for(0s) != std::future_status::ready) return false;
    const Opened opened = opening_.get();
    is_open_ = opened.result == HRT_OK;
    if (is_open_) ++times_opened_;
    message_ = is_open_ ? "the robot is open" : opened.words;
    try_again_ = Clock::now() + 1s;
  }
  if (is_open_) {
    const int result = hrt_get_state(&state);
    if (result == HRT_OK) return true;
    is_open_ = false;
    message_ = words_of(result);
    try_again_ = Clock::now() + 1s;
  } else if (Clock::now() >= try_again_) {
    begin_opening();
  }
  return false;
}

void Robot::carry_out(const Order& order) {
  int result = HRT_OK;
  const auto call = [&](int returned) {
    if (returned != HRT_OK) result = returned;
  };
  if (order.stop) call(hrt_stop());
  if (order.move_flippers) {
    const auto& deg = order.flipper_deg;
    call(hrt_set_flippers(deg[kFrontLeft], deg[kFrontRight], deg[kRearLeft], deg[kRearRight]));
  }
  call(hrt_set_tracks(order.track_mmps[kLeft], order.track_mmps[kRight]));
  if (result != HRT_OK) message_ = words_of(result);
}

}  // namespace kenaf::teleop
