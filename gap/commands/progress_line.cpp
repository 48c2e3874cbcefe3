#include "gap/commands/progress_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace kenaf::gap::commands {
namespace {

constexpr auto kBetween = std::chrono::milliseconds(300);
constexpr double kToTell = 0.05;  // least share of the work for an estimate

std::string in_words(double seconds) {
  if (seconds < 120) return fmt::format("{:.0f} s", seconds);
  if (seconds < 7200) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

bool ProgressLine::is_terminal() {
  return ::isatty(STDERR_FILENO) != 0;
}

std::string time_left(double from, double done, double passed_s) {
  if (done - from <= kToTell * (1 - from)) return {};
  return fmt::format(", about {} left", in_words(passed_s * (1 - done) / (done - from)));
}

void ProgressLine::skip(double done) {
  skipped_ = done;
  start_ = Clock::now();
}

void ProgressLine::show(std::string_view doing, double done) {
  if (!terminal_) return;
  const Clock::time_point now = Clock::now();
  if (doing == doing_ && done < 1 && now - shown_ < kBetween) return;
  doing_ = doing;
  shown_ = now;
  const double passed_s = std::chrono::duration<double>(now - start_).count();
  std::fputs(fmt::format("\r\033[K{:3.0f} %  {}{}", done * 100, doing, time_left(skipped_, done, passed_s)).c_str(),
             stderr);
  if (done >= 1) clear_progress_line();
}

void clear_progress_line() {
  if (::isatty(STDERR_FILENO) != 0) std::fputs("\r\033[K", stderr);
}

}  // namespace kenaf::gap::commands
