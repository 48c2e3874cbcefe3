#include "hrt/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <span>
#include <thread>

#include "hrt/error.hpp"
#include "hrt/quiet_thread.hpp"
#include "robot/state.hpp"

namespace kenaf::hrt {
namespace {

// How long add() waits for the disk, where it may, and how often it looks.
constexpr auto kLongestWait = std::chrono::milliseconds(100), kAskDiskEvery = std::chrono::milliseconds(1);

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

// Index of a quantity's first column in a row.
constexpr std::ptrdiff_t place_of(robot::Quantity quantity) {
  return std::count_if(robot::columns().data(), robot::columns_of(quantity).data(),
                       [](const robot::Column& column) { return column.by_robot; });
}

// Writes `values` into a row, in the order of the quantity's columns.
template <robot::Quantity quantity>
void put(RecordRow& row, std::span<const double> values) {
  constexpr std::ptrdiff_t kPlace = place_of(quantity);
  std::ranges::copy(values, row.begin() + kPlace);
}
template <robot::Quantity quantity>
void put(RecordRow& row, double value) {
  put<quantity>(row, std::span(&value, 1));
}

// A recording may begin at any time: rounding the difference gives identical runs identical files.
double whole_nanoseconds(double t_s) {
  return static_cast<double>(std::llround(t_s * 1e9)) / 1e9;
}

std::unique_ptr<runs::RunWriter> open_writer(const std::string& path) {
  try {
    return std::make_unique<runs::RunWriter>(path, record_columns());
  } catch (const std::exception& error) {
    throw Error(HRT_E_RECORD, fmt::format("the recording cannot be started: {}", error.what()));
  }
}

}  // namespace

std::vector<std::string> record_columns() {
  std::vector<std::string> names;
  for (const robot::Column& column : robot::columns())
    if (column.by_robot) names.emplace_back(column.name);
  return names;
}

RecordRow record_row(const robot::State& state, const robot::Command& command, double t_s) {
  using enum robot::Quantity;
  RecordRow row;
  row.fill(kNotMeasured);
  const auto has = [&](robot::StateField field) { return robot::is_new(state.fields, field); };

  // commanded
  put<time>(row, t_s);
  put<track_command>(row, command.track_speed_mps);
  std::array<double, robot::kFlipperCount> flipper_rad;
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i)
    flipper_rad[i] = command.flipper[i].mode == robot::JointMode::angle ? command.flipper[i].value : kNotMeasured;
  put<flipper_command>(row, flipper_rad);

  // measured
  if (has(robot::kHasEncoders)) {
    put<track_speed>(row, state.track_mps);
    put<track_travel>(row, state.track_m);
  }
  if (has(robot::kHasFlippers)) put<flipper_angle>(row, state.flipper_rad);
  if (has(robot::kHasCurrents)) {
    put<track_current>(row, state.track_a);
    if ((state.fields & robot::kHeldFlipperCurrents) == 0) put<flipper_current>(row, state.flipper_a);
  }
  if (has(robot::kHasBattery)) put<battery_voltage>(row, state.battery_v);
  if (has(robot::kHasGroundTruth)) {
    put<position>(row, state.p_WB_m);
    put<tilt>(row, std::span(state.orientation_rad).first(2));
    put<yaw>(row, state.orientation_rad[2]);
  }
  if (has(robot::kHasInertial)) {
    put<turn_rate>(row, state.gyro_radps);
    put<acceleration>(row, state.acceleration_mps2);
  }
  if (has(robot::kHasPosture)) put<posture>(row, state.posture_rad);

  // course of the cycle
  put<robot_time>(row, state.robot_time_s);
  put<frame>(row, state.frame);
  put<late_commands>(row, state.late_commands);
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
    // callers interested in the error call finish()
  }
}

void Recorder::add(const robot::State& state, const robot::Command& command, double t_s) {
  if (!started_) {
    started_ = true;
    start_t_s_ = t_s;
  } else if (t_s <= last_t_s_) {
    return;
  }
  last_t_s_ = t_s;
  const std::uint32_t added = added_.load(std::memory_order_relaxed);
  const auto has_room = [&] { return added - taken_.load(std::memory_order_acquire) < kQueueRows; };
  if (wait_when_full_ && !has_room()) {
    const auto latest = std::chrono::steady_clock::now() + kLongestWait;
    while (!has_room() && std::chrono::steady_clock::now() < latest) std::this_thread::sleep_for(kAskDiskEvery);
  }
  if (!has_room()) {
    ++lost_;
    return;
  }
  queue_[added % kQueueRows] = record_row(state, command, whole_nanoseconds(t_s - start_t_s_));
  added_.store(added + 1, std::memory_order_release);
  ++wake_;
  wake_.notify_one();
}

void Recorder::write_rows() {
  for (;;) {
    // in this order: a row or an end that comes after the first line changes wake_, and so ends the wait
    const std::uint32_t seen = wake_.load();
    const bool is_last = ended_.load();
    const std::uint32_t taken = taken_.load(std::memory_order_relaxed);
    if (taken == added_.load(std::memory_order_acquire)) {
      if (is_last) return;
      wake_.wait(seen);
      continue;
    }
    try {
      if (is_writing()) writer_->add_row(queue_[taken % kQueueRows]);
    } catch (const std::exception& error) {
      failure_ = error.what();
      broken_.store(true, std::memory_order_release);
    }
    taken_.store(taken + 1, std::memory_order_release);
  }
}

std::string Recorder::lost_rows() const {
  return fmt::format("{0}: {1} rows are missing, because the disk was too slow; {0}.part has the others", path_,
                     lost_.load());
}

std::string Recorder::trouble() const {
  if (!is_writing()) return fmt::format("the recording is incomplete: {}", failure_);
  return lost_ > 0 ? lost_rows() : std::string();
}

void Recorder::finish() {
  ended_ = true;
  ++wake_;
  wake_.notify_one();
  if (thread_.joinable()) {
    thread_.join();
    try {
      if (is_writing() && started_ && lost_ == 0) writer_->finish();
    } catch (const std::exception& error) {
      failure_ = error.what();
      broken_ = true;
    }
    writer_.reset();
  }
  if (const std::string incomplete = trouble(); !incomplete.empty()) throw Error(HRT_E_RECORD, incomplete);
}

}  // namespace kenaf::hrt
