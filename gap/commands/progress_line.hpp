// How far a long command is, on standard error: one line that is written over a few times a second, on a terminal only.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace kenaf::gap::commands {

class ProgressLine {
 public:
  // `done`: share of everything, 0 to 1; at 1 the line goes away.
  void show(std::string_view doing, double done);
  // That much was there already, and took none of the time by which the time left is reckoned.
  void skip(double done);
  bool on_terminal() const { return terminal_; }

 private:
  static bool is_terminal();
  using Clock = std::chrono::steady_clock;
  bool terminal_ = is_terminal();
  Clock::time_point start_ = Clock::now(), shown_{};
  std::string doing_;
  double skipped_ = 0;
};

// Takes away a line that is not finished, before something else is said.
void clear_progress_line();

// ", about 5 min left" after `passed_s` in which it came from `from` to `done`; empty where that is too little to tell.
std::string time_left(double from, double done, double passed_s);

}  // namespace kenaf::gap::commands
