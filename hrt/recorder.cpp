#include "hrt/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "hrt/error.hpp"
#include "hrt/quiet_thread.hpp"
#include "robot/state.hpp"

namespace kenaf::hrt {
namespace {

constexpr auto kLongestWait = std::chrono::milliseconds(100);

// A recording begins anywhere: without the rounding of its difference the same run has the same file.
double whole_nanoseconds(double t_s) {
  return static_cast<double>(std::llround(t_s * 1e9)) / 1e9;
}

std::unique_ptr<runs::RunWriter> open_writer(const std::string& path) {
  try {
    return std::make_unique<runs::RunWriter>(path, record_columns());
  } catch (const std::exception& error) {
    throw Error(HRT_E_RECORD, fmt::format("the recording cannot be begun: {}", error.what()));
  }
}

}  // namespace

const std::vector<std::string>& record_columns() {
  static const std::vector<std::string> columns = {
      "t_s", "cmd_track_left_mps", "cmd_track_right_mps", "cmd_flipper_fl_rad", "cmd_flipper_fr_rad",
      "cmd_flipper_rl_rad", "cmd_flipper_rr_rad", "track_left_mps", "track_right_mps", "track_left_m", "track_right_m",
      "flipper_fl_rad", "flipper_fr_rad", "flipper_rl_rad", "flipper_rr_rad", "track_left_a", "track_right_a",
      "flipper_fl_a", "flipper_fr_a", "flipper_rl_a", "flipper_rr_a", "battery_v", "x_m", "y_m", "z_m", "roll_rad",
      "pitch_rad", "yaw_rad", "gyro_x_radps", "gyro_y_radps", "gyro_z_radps", "acc_x_mps2", "acc_y_mps2", "acc_z_mps2",
      // Beyond the format: what the robot's own posture sensor says, and how the cycle went.
      "posture_roll_rad", "posture_pitch_rad", "posture_yaw_rad", "robot_time_s", "frame", "late_commands"};
  return columns;
}

RecordRow record_row(const robot::State& state, const DriveCommand& command, double t_s) {
  RecordRow row;
  std::size_t next = 0;
  const auto put = [&](double value) { row[next++] = value; };
  const auto put_all = [&](const auto& values, bool measured) {
    for (const double value : values) put(measured ? value : std::numeric_limits<double>::quiet_NaN());
  };
  const auto has = [&](robot::StateField field) { return robot::is_new(state.fields, field); };

  put(t_s);
  put_all(command.track_speed_mps, true);
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
    put_all(std::array{command.flipper_rad[i]}, (command.flipper_mask >> i & 1) != 0);
  }
  put_all(state.track_mps, has(robot::kHasEncoders));
  put_all(state.track_m, has(robot::kHasEncoders));
  put_all(state.flipper_rad, has(robot::kHasFlippers));
  put_all(state.track_a, has(robot::kHasCurrents));
  put_all(state.flipper_a, has(robot::kHasCurrents));
  put_all(std::array{state.battery_v}, has(robot::kHasBattery));
  put_all(state.p_WB_m, has(robot::kHasGroundTruth));
  put_all(state.orientation_rad, has(robot::kHasGroundTruth));
  put_all(state.gyro_radps, has(robot::kHasInertial));
  put_all(state.acceleration_mps2, has(robot::kHasInertial));
  put_all(state.posture_rad, has(robot::kHasPosture));
  put(state.robot_time_s);
  put(state.frame);
  put(state.late_commands);
  return row;
}

Recorder::Recorder(const std::string& path, bool wait_when_full)
    : path_(path),
      wait_when_full_(wait_when_full),
      writer_(open_writer(path)),
      queue_(kQueueRows),
      thread_(start_quiet_thread([this] { write_rows(); })) {}

Recorder::~Recorder() {
  try {
    finish();
  } catch (const std::exception&) {
    // whoever wants to know calls finish()
  }
}

void Recorder::add(const robot::State& state, const DriveCommand& command, double t_s) {
  std::unique_lock lock(mutex_);
  if (!started_) {
    started_ = true;
    start_t_s_ = t_s;
  } else if (t_s <= last_t_s_) {
    return;
  }
  last_t_s_ = t_s;
  const auto has_room = [&] { return count_ < kQueueRows; };
  if (wait_when_full_) row_taken_.wait_for(lock, kLongestWait, has_room);
  if (!has_room() || ended_) {
    ++lost_;
    return;
  }
  queue_[(first_ + count_) % kQueueRows] = record_row(state, command, whole_nanoseconds(t_s - start_t_s_));
  ++count_;
  row_added_.notify_one();
}

void Recorder::write_rows() {
  std::unique_lock lock(mutex_);
  for (;;) {
    row_added_.wait(lock, [&] { return count_ > 0 || ended_; });
    if (count_ == 0) return;
    const RecordRow row = queue_[first_];
    first_ = (first_ + 1) % kQueueRows;
    --count_;
    row_taken_.notify_one();
    if (!failure_.empty()) continue;
    lock.unlock();
    std::string failure;
    try {
      writer_->add_row(row);
    } catch (const std::exception& error) {
      failure = error.what();
    }
    lock.lock();
    failure_ = failure;
  }
}

void Recorder::finish() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    row_added_.notify_one();
  }
  if (thread_.joinable()) {
    thread_.join();
    try {
      if (failure_.empty() && started_ && lost_ == 0) writer_->finish();
    } catch (const std::exception& error) {
      failure_ = error.what();
    }
    writer_.reset();
  }
  if (!failure_.empty()) throw Error(HRT_E_RECORD, fmt::format("the recording is not whole: {}", failure_));
  if (lost_ > 0) {
    throw Error(HRT_E_RECORD,
                fmt::format("{0}: {1} rows are missing: the disk was too slow; {0}.part has the others", path_, lost_));
  }
}

}  // namespace kenaf::hrt
