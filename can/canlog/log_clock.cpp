#include "can/canlog/log_clock.hpp"

#include <algorithm>

namespace kenaf::canlog {

using canopen::RecordedFrame;
using canopen::Stamp;
using canopen::Time;

namespace {

constexpr Time kOutOfOrder = std::chrono::milliseconds(1);
constexpr Time kLastTime = std::chrono::seconds(9'000'000'000);  // sums beyond do not fit in 64-bit nanoseconds
constexpr std::size_t kLeastShare = 4;

Time sum_of(Time a, Time b) {
  return b > kLastTime - a ? kLastTime : a + b;
}

}  // namespace

bool are_intervals(std::span<const RecordedFrame> lines) {
  std::size_t pairs = 0, not_later = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (lines[i].stamp != Stamp::short_seconds || lines[i - 1].stamp != Stamp::short_seconds) continue;
    ++pairs;
    if (lines[i].at <= lines[i - 1].at) ++not_later;
  }
  return kLeastShare * not_later > pairs;
}

void sum_up(std::span<RecordedFrame> lines) {
  Time now{};
  for (RecordedFrame& line : lines) {
    if (line.stamp != Stamp::short_seconds) continue;
    now = sum_of(now, line.at);
    line.at = now;
  }
}

std::vector<ClockStep> remove_steps(std::span<LogFrame> frames) {
  std::vector<ClockStep> steps;
  Time recorded{}, removed{}, last{};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    LogFrame& frame = frames[i];
    if (i > 0 && recorded - frame.at > kOutOfOrder) {
      steps.push_back({frame.line, recorded - frame.at});
      removed = last - frame.at;
    }
    recorded = frame.at;
    const Time continuous = sum_of(frame.at, removed);
    frame.at = i == 0 ? continuous : std::max(last, continuous);
    last = frame.at;
    frame.clock_steps = steps.size();
  }
  return steps;
}

}  // namespace kenaf::canlog
