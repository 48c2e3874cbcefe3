// An open robot: the cycle thread that answers every state of the transport, and the calls in which user threads wait.
// SI units; hrt.cpp converts to those of hrt.h.
//
// One cycle: take the state, step the motion and the waiting calls, hold the answer while a program whose call has just
// ended is due to make its next one (lock step only), send the answer.
//
// Motions and waiting calls are stepped by the cycle, in the state that the program's calls change; one mutex guards
// both. A real-time cycle must not wait for a program, though: its thread may lose its processor while it has the
// mutex. So a robot that does not wait is answered by the previous command where the mutex does not become free in
// time; the state is taken in with the next one, and nothing but the moment of a new command is lost. A slot for values
// between the two, without a mutex, would split each call into two halves that must agree about every ending.
#pragma once

#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "hrt/error.hpp"
#include "hrt/estimate.hpp"
#include "hrt/motion.hpp"
#include "hrt/recorder.hpp"
#include "hrt/thread_watch.hpp"
#include "hrt/transport.hpp"
#include "kenaf/hrt.h"
#include "robot/state.hpp"

namespace kenaf::hrt {

// All quantities as of one cycle, the last one if the robot is lost or closed.
struct Snapshot {
  robot::State measured{};
  Estimate estimate;
  robot::Command commanded;
  std::uint64_t lost_cycles = 0;
  double round_trip_s = 0;
  std::string warning;
  bool motion_active = false, paused = false, stopped_by_silence = false, recording = false, lockstep = false;
  std::optional<Failure> lost;  // why, if the robot is lost or closed
};

// Thread safety: every function may be called from any thread. All but snapshot(), is_lost() and robot_time_at() throw
// Error with the codes that hrt.h names.
class Robot {
 public:
  // Opens the transport, waits for the first state and, if configured, begins a recording.
  Robot(std::unique_ptr<Transport> transport, const hrt_config& config);
  ~Robot();
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;

  // These block.
  void go_forward(double distance_m);
  void turn(double angle_rad);
  void wait_flippers(double tolerance_rad, double timeout_s);
  void sleep(double seconds);
  void wait_cycle();
  // For waits that no cycle ends: calls `wait_a_little`, which takes at most some tens of milliseconds, until it
  // returns true. Robot time continues meanwhile, and the program counts as calling.
  void wait_while_cycling(const std::function<bool()>& wait_a_little);

  void set_tracks(double left_mps, double right_mps);
  void set_flippers(std::uint8_t mask, const std::array<double, robot::kFlipperCount>& angle_rad);
  void stop();

  void record_start(const std::string& path);
  void record_stop();

  // Does not throw if the robot is lost; otherwise notes that the program has called.
  Snapshot snapshot();
  bool is_lost() const;
  // What the transport has found and set up when it was opened.
  const std::string& setup() const { return setup_; }
  // Throws if the link is lost or the robot closed; otherwise notes that the program has called.
  void note_call();
  // Converts a recent moment of the wall clock to robot time, by the newest cycle; nullopt in lock step, where robot
  // time does not follow the wall clock.
  std::optional<double> robot_time_at(std::chrono::steady_clock::time_point moment) const;

  // For tests: as the call of a program whose thread loses its processor while it has the mutex.
  [[nodiscard]] std::unique_lock<std::mutex> hold_mutex() { return std::unique_lock(mutex_); }

  // Stops the robot and ends every call with HRT_E_CLOSED; a recording ends with the current cycle. Throws if the
  // recording is incomplete.
  void close();

 private:
  // Result of a call: a code, and a text if it failed.
  struct Verdict {
    int code;
    std::string text;
  };
  enum class Kind { motion, flippers, time, wait };
  // A blocking call; it lives on the stack of the waiting thread.
  struct Call {
    Kind kind;
    std::function<std::optional<Verdict>()> step;  // looks at the newest cycle; called under the lock
    pid_t owner = gettid();
    std::uint32_t start_frame = 0;  // it ends in a later cycle than this
    std::uint32_t stepped_frame = 0;
    std::optional<Verdict> verdict{};
  };
  // A thread whose call has just ended: the answer is held until its next call.
  struct Due {
    pid_t thread;
    ThreadWatch watch{};
  };
  template <typename Motion>
  void run_motion(Motion motion, double heading_rad, std::unique_lock<std::mutex>& lock);
  void wake_calls();
  void run_call(Call& call, std::unique_lock<std::mutex>& lock);
  void end_calls(const std::function<bool(const Call&)>& which, int code, const std::string& text);

  void begin_thread(const robot::State& first);  // throws what prepare_cycles() and begin_cycles() throw
  void run(robot::State state);
  std::optional<robot::Command> answer(const robot::State& state);  // nullopt: closed before
  bool lock_soon(std::unique_lock<std::mutex>& lock) const;
  robot::Command answer_without_calls(const robot::State& state);
  void take(const robot::State& state, const robot::Command& in_force);
  void step_calls();
  void hold(std::unique_lock<std::mutex>& lock);
  void look_at_due();
  void compose_command();
  void fail(int code, const std::string& text);

  std::unique_lock<std::mutex> lock_open();  // throws if the link is lost or the robot closed
  void note_setting();                       // the program has changed a setting: it is active
  double motion_heading() const;
  bool motion_active() const;
  void begin_motion();
  void set_user_tracks(const std::array<double, robot::kTrackCount>& mps);
  bool flipper_is_off(std::size_t flipper, double tolerance_rad) const;

  const hrt_config config_;
  const MotionLimits limits_;
  std::unique_ptr<Transport> transport_;
  Connection connection_{};
  std::string setup_;  // of the opening, constant afterwards

  mutable std::mutex mutex_;               // guards all members below
  std::condition_variable program_acted_;  // waited for in lock step only
  // Changes when calls end, and their threads sleep on it. No condition variable: to wake by one may wait for threads
  // that it has woken before and that have had no processor since (glibc's wait for its older group).
  std::atomic<std::uint32_t> calls_ended_ = 0;
  std::optional<Failure> failure_;  // link lost or closed: set once
  bool closing_ = false;
  robot::State measured_{};
  std::chrono::steady_clock::time_point measured_at_;  // when it was received
  Estimator estimator_;
  Estimate estimate_;
  std::uint64_t lost_cycles_ = 0;
  std::string warning_;
  robot::Command command_;   // the newest answer, in force from the next cycle on
  robot::Command in_force_;  // what was sent before: in force since measured_
  std::array<double, robot::kTrackCount> user_track_mps_{};
  bool stopped_by_silence_ = false;  // silence has set them to 0, and no speed was requested since
  std::array<double, robot::kTrackCount> motion_track_mps_{};
  std::array<robot::JointCommand, robot::kFlipperCount> user_flipper_{};
  bool world_was_reset_ = false;            // in a cycle that was taken and not yet stepped
  std::optional<double> goal_heading_rad_;  // of the previous motion, while nothing else has moved the robot
  double last_call_t_s_ = 0;
  std::vector<Call*> calls_;  // the waiting ones
  std::vector<Due> due_;
  std::unique_ptr<Recorder> recorder_;

  // ---- of the cycle thread alone ----
  // States that came while the mutex was not free; if there are more, the oldest ones are lost cycles.
  static constexpr std::size_t kMostUntaken = 64;
  struct Untaken {
    robot::State state;
    robot::Command in_force;
  };
  std::array<Untaken, kMostUntaken> untaken_{};
  std::size_t untaken_count_ = 0;
  robot::Command sent_;               // the newest answer
  std::uint32_t composed_frame_ = 0;  // the frame whose answer was composed last
  double composed_silence_s_ = 0;     // and how long the program had not called then

  std::mutex close_mutex_;   // one close at a time
  std::mutex record_mutex_;  // one recording starts or ends at a time; locked before mutex_, never by the cycle thread
  std::thread thread_;
};

}  // namespace kenaf::hrt
