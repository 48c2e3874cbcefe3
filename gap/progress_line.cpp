#include "gap/progress_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <string>

namespace kenaf::gap {
namespace {

std::string in_words(double seconds) {
  if (seconds < 120) return fmt::format("{:.0f} s", seconds);
  if (seconds < 7200) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

bool ProgressLine::is_terminal() {
  return ::isatty(STDERR_FILENO) != 0;
}

void ProgressLine::show(std::string_view doing, double done) const {
  if (!terminal_) return;
  const double passed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const std::string left = done > 0.05 ? fmt::format(", about {} left", in_words(passed_s * (1 / done - 1))) : "";
  std::fputs(fmt::format("\r\033[K{:3.0f} %  {}{}", done * 100, doing, left).c_str(), stderr);
  if (done >= 1) clear_progress_line();
}

void clear_progress_line() {
  if (::isatty(STDERR_FILENO) != 0) std::fputs("\r\033[K", stderr);
}

}  // namespace kenaf::gap
