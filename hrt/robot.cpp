#include "hrt/robot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <future>
#include <numbers>
#include <utility>

#include "hrt/motion_forward.hpp"
#include "hrt/motion_turn.hpp"
#include "hrt/quiet_thread.hpp"
#include "hrt/warnings.hpp"
#include "robot/state.hpp"

namespace kenaf::hrt {
namespace {

using Clock = std::chrono::steady_clock;

// An answer is held for less than the 2 s after which a world server stops waiting in lock step.
constexpr auto kLongestHold = std::chrono::seconds(1);
// A cycle of a robot that does not wait is answered without the program's calls if one has the mutex for longer:
// chosen, a fiftieth of a period of 10 ms, and a hundred times what a call needs.
constexpr auto kLongestLock = std::chrono::microseconds(200);
// Period at which a hold checks the program: a fast program is never checked.
constexpr auto kLookEvery = std::chrono::milliseconds(5);
// A motion reuses the goal heading of the previous motion if the robot is within this angle of it.
constexpr double kSameHeading_rad = 2 * std::numbers::pi / 180;
// hrt_stop keeps the command of a flipper that has arrived, so that its servo does not creep.
constexpr double kFlipperArrived_rad = 2 * std::numbers::pi / 180;
// Cycle times are sums of periods: a wait for ten of them must not miss the tenth by rounding.
constexpr double kCycleRounding = 1e-3;

// Room from the start; more needs an allocation in a cycle.
constexpr std::size_t kMostWarning = 2048, kMostDue = 256;

constexpr std::string_view kWorldWasReset =
    "somebody reset the world during this motion: the robot is back at its start; begin the motion again from there";

constexpr const char* kFlipperNames[] = {"front left", "front right", "rear left", "rear right"};

}  // namespace

Robot::Robot(std::unique_ptr<Transport> transport, const hrt_config& config)
    : config_(config),
      limits_(motion_limits_from(config)),
      transport_(std::move(transport)),
      estimator_({limits_.track_gauge_m, config.turn_efficiency}) {
  try {
    connection_ = transport_->open(config_);
    setup_ = transport_->setup();
    const std::optional<robot::State> first = transport_->wait_state();
    if (!first) throw Error(HRT_E_INTERNAL, "the transport was interrupted while it was being opened");
    // The first cycle is known before the constructor returns.
    measured_ = *first;
    measured_at_ = Clock::now();
    estimate_ = estimator_.update(*first);
    warning_ = transport_->warning();
    last_call_t_s_ = estimate_.t_s;
    // no cycle allocates: warnings, and threads that are waited for, find room
    warning_.reserve(kMostWarning);
    due_.reserve(kMostDue);
    due_.push_back({gettid()});
    if (config_.record[0] != '\0') recorder_ = std::make_unique<Recorder>(config_.record, connection_.lockstep);
    if (recorder_) recorder_->add(*first, in_force_, estimate_.t_s);
    begin_thread(*first);
  } catch (...) {
    try {
      transport_->close();
    } catch (const std::exception&) {
      // the first error is the relevant one
    }
    throw;
  }
}

void Robot::begin_thread(const robot::State& first) {
  std::promise<void> prepared, begun;
  std::future<void> outcome = begun.get_future();
  thread_ = start_quiet_thread([this, first, may_begin = prepared.get_future(), begun = std::move(begun)]() mutable {
    try {
      may_begin.get();
      transport_->begin_cycles();
      begun.set_value();
    } catch (...) {
      begun.set_exception(std::current_exception());
      return;
    }
    run(first);
  });
  try {
    transport_->prepare_cycles(thread_.native_handle());
    prepared.set_value();
  } catch (...) {
    prepared.set_exception(std::current_exception());
  }
  try {
    outcome.get();
  } catch (...) {
    thread_.join();
    throw;
  }
}

Robot::~Robot() {
  try {
    close();
  } catch (const std::exception&) {
    // callers interested in the error call close()
  }
}

// ---- Calls that block ----

void Robot::go_forward(double distance_m) {
  std::unique_lock lock = lock_open();
  begin_motion();
  const double heading_rad = motion_heading();
  run_motion(GoForward(limits_, distance_m, heading_rad, estimate_), heading_rad, lock);
}

void Robot::turn(double angle_rad) {
  std::unique_lock lock = lock_open();
  begin_motion();
  const double goal_rad = motion_heading() + angle_rad;
  run_motion(TurnInPlace(limits_, goal_rad, estimate_), goal_rad, lock);
}

void Robot::wait_flippers(double tolerance_rad, double timeout_s) {
  std::unique_lock lock = lock_open();
  if ((measured_.fields & robot::kHasFlippers) == 0) {
    throw Error(HRT_E_DEVICE, "hrt_wait_flippers: this robot does not measure its flippers");
  }
  const double deadline_s = estimate_.t_s + timeout_s;
  Call call{
      .kind = Kind::flippers, .step = [&]() -> std::optional<Verdict> {
        bool all_there = true;
        for (std::size_t i = 0; i < robot::kFlipperCount; ++i) all_there &= !flipper_is_off(i, tolerance_rad);
        if (all_there) return Verdict{HRT_OK, {}};
        if (estimate_.t_s < deadline_s) return std::nullopt;
        std::string late;
        for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
          if (flipper_is_off(i, tolerance_rad)) late += std::string(late.empty() ? "" : ", ") + kFlipperNames[i];
        }
        return Verdict{HRT_E_TIMEOUT, fmt::format("hrt_wait_flippers: not reached within {} s: {}", timeout_s, late)};
      }};
  run_call(call, lock);
}

void Robot::sleep(double seconds) {
  std::unique_lock lock = lock_open();
  const double until_s = estimate_.t_s + seconds - kCycleRounding * connection_.period_s;
  Call call{.kind = Kind::time, .step = [&]() -> std::optional<Verdict> {
              return estimate_.t_s >= until_s ? std::optional(Verdict{HRT_OK, {}}) : std::nullopt;
            }};
  run_call(call, lock);
}

void Robot::wait_cycle() {
  std::unique_lock lock = lock_open();
  Call call{.kind = Kind::time, .step = [] { return Verdict{HRT_OK, {}}; }};
  run_call(call, lock);
}

bool Robot::motion_active() const {
  return std::ranges::any_of(calls_, [](const Call* call) { return call->kind == Kind::motion; });
}

void Robot::wait_while_cycling(const std::function<bool()>& wait_a_little) {
  // Counts as a call under way, so the command does not time out; only closing or losing the robot gives it a verdict.
  Call call{.kind = Kind::wait, .step = [] { return std::optional<Verdict>(); }};
  std::unique_lock lock = lock_open();
  // Robot time continues: no answer is held for this thread.
  calls_.push_back(&call);
  std::erase_if(due_, [&](const Due& due) { return due.thread == call.owner; });
  program_acted_.notify_one();

  // Afterwards the answer is held for this thread's next call, unless the robot is lost.
  const auto leave = [&] {
    std::erase(calls_, &call);
    last_call_t_s_ = estimate_.t_s;
    if (!call.verdict) due_.push_back({call.owner});
  };

  // Waits without the lock, which the cycle thread needs.
  try {
    for (bool done = false; !done && !call.verdict;) {
      lock.unlock();
      done = wait_a_little();
      lock.lock();
    }
  } catch (...) {
    lock.lock();
    leave();
    throw;
  }
  leave();
  if (call.verdict) throw Error(call.verdict->code, call.verdict->text);
}

void Robot::begin_motion() {
  if (motion_active()) throw Error(HRT_E_BUSY, "a motion is running in another thread; hrt_stop() ends it");
  if (!estimate_.has_encoders) throw Error(HRT_E_DEVICE, "this robot reports no track encoders");
  set_user_tracks({});
  motion_track_mps_ = {};
}

double Robot::motion_heading() const {
  const double near_rad = std::max(kSameHeading_rad, limits_.angle_tolerance_rad);
  const bool is_near = goal_heading_rad_ && std::abs(*goal_heading_rad_ - estimate_.heading_rad) <= near_rad;
  return is_near ? *goal_heading_rad_ : estimate_.heading_rad;
}

template <typename Motion>
void Robot::run_motion(Motion motion, double heading_rad, std::unique_lock<std::mutex>& lock) {
  goal_heading_rad_.reset();
  Call call{.kind = Kind::motion, .step = [&]() -> std::optional<Verdict> {
              const MotionStep step = motion.step(estimate_);
              motion_track_mps_ = step.track_speed_mps;
              if (!step.finished) return std::nullopt;
              if (step.code == HRT_OK) goal_heading_rad_ = heading_rad;
              return Verdict{step.code, step.text};
            }};
  run_call(call, lock);
}

void Robot::run_call(Call& call, std::unique_lock<std::mutex>& lock) {
  call.start_frame = estimate_.frame;
  calls_.push_back(&call);
  std::erase_if(due_, [&](const Due& due) { return due.thread == call.owner; });
  program_acted_.notify_one();
  while (!call.verdict) {
    const std::uint32_t seen = calls_ended_;  // verdicts come under the lock: none is missed
    lock.unlock();
    calls_ended_.wait(seen);
    lock.lock();
  }
  if (call.verdict->code != HRT_OK) throw Error(call.verdict->code, call.verdict->text);
}

void Robot::end_calls(const std::function<bool(const Call&)>& which, int code, const std::string& text) {
  std::erase_if(calls_, [&](Call* call) {
    if (!which(*call)) return false;
    call->verdict = Verdict{code, text};
    return true;
  });
  wake_calls();
}

void Robot::wake_calls() {
  ++calls_ended_;
  calls_ended_.notify_all();
}

// ---- Calls that do not block ----

std::unique_lock<std::mutex> Robot::lock_open() {
  std::unique_lock lock(mutex_);
  if (failure_) throw failure_->error();
  last_call_t_s_ = estimate_.t_s;
  return lock;
}

void Robot::note_setting() {
  for (Due& due : due_) due.watch = {};
  program_acted_.notify_one();
}

void Robot::set_user_tracks(const std::array<double, robot::kTrackCount>& mps) {
  user_track_mps_ = mps;
  stopped_by_silence_ = false;
}

void Robot::set_tracks(double left_mps, double right_mps) {
  const std::unique_lock lock = lock_open();
  end_calls([](const Call& call) { return call.kind == Kind::motion; }, HRT_E_STOPPED,
            "hrt_set_tracks() of another thread ended this motion");
  goal_heading_rad_.reset();
  set_user_tracks({left_mps, right_mps});
  note_setting();
}

void Robot::set_flippers(std::uint8_t mask, const std::array<double, robot::kFlipperCount>& angle_rad) {
  const std::unique_lock lock = lock_open();
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
    if ((mask >> i & 1) != 0) user_flipper_[i] = {robot::JointMode::angle, angle_rad[i]};
  }
  note_setting();
}

void Robot::stop() {
  const std::unique_lock lock = lock_open();
  end_calls([](const Call& call) { return call.kind == Kind::motion || call.kind == Kind::flippers; }, HRT_E_STOPPED,
            "hrt_stop() ended this call");
  goal_heading_rad_.reset();
  set_user_tracks({});
  for (std::size_t i = 0; i < robot::kFlipperCount; ++i) {
    if (flipper_is_off(i, kFlipperArrived_rad)) user_flipper_[i].value = measured_.flipper_rad[i];
  }
  note_setting();
}

bool Robot::flipper_is_off(std::size_t flipper, double tolerance_rad) const {
  const robot::JointCommand& command = user_flipper_[flipper];
  const bool known = command.mode == robot::JointMode::angle && (measured_.fields & robot::kHasFlippers) != 0;
  return known && std::abs(measured_.flipper_rad[flipper] - command.value) > tolerance_rad;
}

Snapshot Robot::snapshot() {
  const std::lock_guard lock(mutex_);
  Snapshot out;
  out.measured = measured_;
  out.estimate = estimate_;
  out.commanded = command_;
  out.lost_cycles = lost_cycles_;
  out.warning = warning_;
  if (!closing_) {  // later the transport may be closing without this lock
    out.round_trip_s = transport_->round_trip_s();
    out.paused = transport_->is_paused();
  }
  out.motion_active = motion_active();
  out.stopped_by_silence = stopped_by_silence_;
  out.recording = recorder_ && recorder_->is_writing();
  if (recorder_) out.warning = joined(out.warning, recorder_->trouble());
  out.lockstep = connection_.lockstep;
  out.lost = failure_;
  if (!failure_) last_call_t_s_ = estimate_.t_s;
  return out;
}

bool Robot::is_lost() const {
  const std::lock_guard lock(mutex_);
  return failure_.has_value();
}

void Robot::note_call() {
  (void)lock_open();
}

std::optional<double> Robot::robot_time_at(Clock::time_point moment) const {
  const std::lock_guard lock(mutex_);
  if (connection_.lockstep) return std::nullopt;
  return measured_.robot_time_s + std::chrono::duration<double>(moment - measured_at_).count();
}

void Robot::record_start(const std::string& path) {
  const std::lock_guard one(record_mutex_);
  {
    const std::unique_lock lock = lock_open();
    if (recorder_) {
      const std::string trouble = recorder_->trouble();
      throw Error(HRT_E_BUSY, trouble.empty() ? "a recording is running; hrt_record_stop() ends it"
                                              : "hrt_record_stop() has not been called since " + trouble);
    }
  }
  // the file is created while cycles continue: a disk may take seconds
  auto recorder = std::make_unique<Recorder>(path, connection_.lockstep);
  const std::unique_lock lock = lock_open();
  recorder_ = std::move(recorder);
  recorder_->add(measured_, in_force_, estimate_.t_s);
  note_setting();
}

void Robot::record_stop() {
  const std::lock_guard one(record_mutex_);  // until the file is complete: the next recording may have its name
  std::unique_ptr<Recorder> recorder;
  {
    const std::lock_guard lock(mutex_);  // also if the link is lost: the recording up to then is worth keeping
    recorder = std::move(recorder_);
    last_call_t_s_ = estimate_.t_s;
    note_setting();
  }
  if (!recorder) throw Error(HRT_E_RECORD, "no recording is running");
  recorder->finish();
}

void Robot::close() {
  const std::lock_guard one(close_mutex_);
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    failure_ = Failure{HRT_E_CLOSED, "hrt_close() was called"};
    end_calls([](const Call&) { return true; }, HRT_E_CLOSED, failure_->text);
    program_acted_.notify_one();
  }
  std::optional<Error> not_stopped;
  if (thread_.joinable()) {
    transport_->interrupt();
    thread_.join();
    try {
      transport_->close();
    } catch (const Error& error) {
      not_stopped = error;
    }
  }
  std::unique_ptr<Recorder> recorder;
  {
    const std::lock_guard lock(mutex_);
    recorder = std::move(recorder_);
  }
  try {
    if (recorder) recorder->finish();
  } catch (const Error&) {
    if (!not_stopped) throw;  // a robot that may still move is the more serious error
  }
  if (not_stopped) throw *not_stopped;
}

// ---- The cycle thread ----

void Robot::run(robot::State state) {
  try {
    for (std::optional<robot::State> next = state; next; next = transport_->wait_state()) {
      const std::optional<robot::Command> command = answer(*next);
      if (!command) return;
      transport_->send(*command);
    }
    // after close() its failure stands; otherwise threads waiting for a cycle would wait for ever
    fail(HRT_E_INTERNAL, "the wait for the robot's state ended without hrt_close()");
  } catch (const Error& error) {
    fail(error.code(), error.what());
  } catch (const std::exception& error) {
    fail(HRT_E_INTERNAL, fmt::format("the library's cycle thread failed: {}", error.what()));
  }
}

void Robot::fail(int code, const std::string& text) {
  const std::lock_guard lock(mutex_);
  if (!failure_) failure_ = Failure{code, text};
  end_calls([](const Call&) { return true; }, code, text);
}

std::optional<robot::Command> Robot::answer(const robot::State& state) {
  std::unique_lock lock(mutex_, std::defer_lock);
  if (connection_.lockstep) {
    lock.lock();
  } else if (!lock_soon(lock)) {
    return answer_without_calls(state);
  }
  if (closing_) return std::nullopt;  // this state overtook the interrupt
  for (std::size_t i = 0; i < untaken_count_; ++i) take(untaken_[i].state, untaken_[i].in_force);
  untaken_count_ = 0;
  take(state, sent_);
  step_calls();
  if (connection_.lockstep) {
    hold(lock);
    step_calls();  // those that began during the hold
  } else {
    due_.clear();  // no call is waited for
  }
  compose_command();
  composed_frame_ = state.frame;
  composed_silence_s_ = estimate_.t_s - last_call_t_s_;
  return sent_ = command_;
}

// Without a sleep: to be woken costs more than the microseconds for which a call has the mutex.
bool Robot::lock_soon(std::unique_lock<std::mutex>& lock) const {
  const Clock::time_point latest = Clock::now() + kLongestLock;
  while (!lock.try_lock()) {
    if (Clock::now() > latest) return false;
  }
  return true;
}

// The previous command stays in force, but one to the tracks no longer than after the program's last call.
robot::Command Robot::answer_without_calls(const robot::State& state) {
  if (untaken_count_ == kMostUntaken) {
    std::ranges::move(untaken_.begin() + 1, untaken_.end(), untaken_.begin());
    --untaken_count_;
  }
  untaken_[untaken_count_++] = {state, sent_};
  const double silent_s = composed_silence_s_ + (state.frame - composed_frame_) * connection_.period_s;
  if (silent_s > config_.command_timeout_s + kCycleRounding * connection_.period_s) sent_.track_speed_mps = {};
  return sent_;
}

void Robot::take(const robot::State& state, const robot::Command& in_force) {
  if (state.frame == estimate_.frame) return;  // the constructor has taken the first one
  lost_cycles_ += state.frame - estimate_.frame - 1;
  measured_ = state;
  measured_at_ = Clock::now();
  in_force_ = in_force;
  estimate_ = estimator_.update(state);
  if (estimate_.world_was_reset) {
    world_was_reset_ = true;
    goal_heading_rad_.reset();
  }
  warning_ = transport_->warning();
  if (recorder_) recorder_->add(state, in_force_, estimate_.t_s);
}

void Robot::step_calls() {
  bool ended = false;
  std::erase_if(calls_, [&](Call* call) {
    if (call->stepped_frame == estimate_.frame) return false;
    call->stepped_frame = estimate_.frame;
    // A motion's goal is relative to where it began, where the robot is not any more.
    std::optional<Verdict> verdict = world_was_reset_ && call->kind == Kind::motion
                                         ? Verdict{HRT_E_STOPPED, std::string(kWorldWasReset)}
                                         : call->step();
    if (!verdict || estimate_.frame == call->start_frame) return false;
    call->verdict = std::move(verdict);
    due_.push_back({call->owner});
    ended = true;
    return true;
  });
  world_was_reset_ = false;
  if (ended) {
    last_call_t_s_ = estimate_.t_s;
    wake_calls();
  }
}

void Robot::hold(std::unique_lock<std::mutex>& lock) {
  const Clock::time_point latest = Clock::now() + kLongestHold;
  if (config_.hold_s == 0) due_.clear();
  while (!due_.empty() && !closing_ && Clock::now() < latest) {
    const std::cv_status woken = program_acted_.wait_until(lock, Clock::now() + kLookEvery);
    if (woken == std::cv_status::timeout) look_at_due();
    transport_->keep_alive();
  }
  due_.clear();
}

// Releases threads that have kept robot time waiting long enough by their own doing.
void Robot::look_at_due() {
  const double wall_s = std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
  std::erase_if(due_, [&](Due& due) {
    due.watch.look(look_at_thread(due.thread), wall_s);
    return due.watch.spent_s() >= config_.hold_s;
  });
}

void Robot::compose_command() {
  if (!calls_.empty()) last_call_t_s_ = estimate_.t_s;
  const double silent_s = estimate_.t_s - last_call_t_s_ - kCycleRounding * connection_.period_s;
  if (silent_s > config_.command_timeout_s && user_track_mps_ != std::array<double, robot::kTrackCount>{}) {
    user_track_mps_ = {};
    stopped_by_silence_ = true;
  }
  command_.track_speed_mps = motion_active() ? motion_track_mps_ : user_track_mps_;
  if (closing_) command_.track_speed_mps = {};
  command_.flipper = user_flipper_;
}

}  // namespace kenaf::hrt
