// How far a long command is, on standard error: one line that is written over, on a terminal only.
#pragma once

#include <chrono>
#include <string_view>

namespace kenaf::gap {

class ProgressLine {
 public:
  // `done`: share of everything, 0 to 1; at 1 the line goes away.
  void show(std::string_view doing, double done) const;
  bool on_terminal() const { return terminal_; }

 private:
  static bool is_terminal();
  bool terminal_ = is_terminal();
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Takes away a line that is not finished, before something else is said.
void clear_progress_line();

}  // namespace kenaf::gap
