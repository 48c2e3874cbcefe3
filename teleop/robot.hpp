// The robot behind hrt.h, opened and opened again in a thread of its own: opening waits for seconds, and the control
// process owes its console an answer twenty times a second meanwhile.
#pragma once

#include <kenaf/hrt.h>

#include <chrono>
#include <future>
#include <string>

#include "driving.hpp"

namespace kenaf::teleop {

// Thread safety: belongs to one thread.
class Robot {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Robot(const hrt_config& config);  // begins to open it
  ~Robot();                                  // stops and closes it

  // The newest state, and whether the robot is open. One that was lost or could not be opened is opened again after a
  // second; it stays where it is then, and its recording goes on in a second file (run-2.csv).
  bool look(hrt_state& state);
  void carry_out(const Order& order);
  const std::string& message() const { return message_; }  // what happened last, for people

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
