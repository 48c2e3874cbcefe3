// The robot behind hrt.h, opened and reopened in a separate thread: opening takes seconds, and the control process must
// keep answering its console twenty times a second meanwhile.
#pragma once

#include <kenaf/hrt.h>

#include <chrono>
#include <future>
#include <string>

#include "driving.hpp"

namespace kenaf::teleop {

// Thread safety: one thread.
class Robot {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Robot(const hrt_config& config);  // starts opening it
  ~Robot();                                  // stops and closes it

  // Returns the newest state, and whether the robot is open. A robot that was lost or could not be opened is opened
  // again after a second; it then stays where it is, and its recording continues in a second file (run-2.csv).
  bool look(hrt_state& state);
  void carry_out(const Order& order);
  const std::string& message() const { return message_; }  // the last event, as text

 private:
  struct Opened {
    int result;
    std::string words;
  };
  void begin_opening();

  hrt_config config_;
  std::string record_;
  int times_opened_ = 0;
  std::future<Opened> opening_;
  Clock::time_point try_again_{};
  bool is_open_ = false;
  std::string message_;
};

}  // namespace kenaf::teleop
