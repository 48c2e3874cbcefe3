// The progress of a long command on standard error: one line, rewritten a few times a second, on a terminal only.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace kenaf::gap::commands {

class ProgressLine {
 public:
  // `done`: share of the whole, 0 to 1; at 1 the line is erased.
  void show(std::string_view doing, double done);
  // Declares the share `done` as done before, so that the estimate of the time left ignores it.
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

// Erases an unfinished line before other output.
void clear_progress_line();

// Returns ", about 5 min left" after progress from `from` to `done` in `passed_s`; empty if that is too little to tell.
std::string time_left(double from, double done, double passed_s);

}  // namespace kenaf::gap::commands
