#include "tests/support/simulated_bus.hpp"

#include <algorithm>
#include <utility>

namespace kenaf::candrives {

using canopen::Frame;
using canopen::ReceivedFrame;
using canopen::Time;

Time time_on_bus(const Frame& frame) {
  return canopen::worst_case_bits(frame) * kBitTime;
}

SimulatedBus::SimulatedBus(const canbus::RobotBus& bus, Plant& plant) : slaves_(bus, plant, Time::zero()) {}

// ---- as the master has it ----

void SimulatedBus::check_up() const {
  if (down_) throw canopen::BusError(*down_);
}

void SimulatedBus::send(const Frame& frame) {
  check_up();
  put(frame, Sender::master);
}

std::optional<ReceivedFrame> SimulatedBus::receive(Time until) {
  while (true) {
    check_up();
    if (!in_socket_.empty()) {
      ReceivedFrame first = in_socket_.front();
      in_socket_.pop_front();
      first.at -= suspended_;
      return first;
    }
    if (std::exchange(interrupted_, false)) return std::nullopt;
    if (auto received = step(until + suspended_)) {
      received->at -= suspended_;
      return received;
    }
    if (now() >= until) return std::nullopt;
  }
}

void SimulatedBus::start_sync(Time period) {
  check_up();
  if (master_dead_) return;
  sync_period_ = period;
  next_sync_ = now_;
}

void SimulatedBus::stop_sync() {
  sync_period_.reset();
}

// ---- as tests have it ----

void SimulatedBus::inject(const Fault& fault) {
  Frames frames;
  slaves_.inject(fault, now_, frames);
  put_all(frames);
}

double SimulatedBus::load() const {
  return now_ > Time::zero() ? static_cast<double>(busy_.count()) / static_cast<double>(now_.count()) : 0;
}

void SimulatedBus::stop_master() {
  master_dead_ = true;
  stop_sync();
  std::erase_if(waiting_, [](const Waiting& one) { return one.sender == Sender::master; });
}

void SimulatedBus::go_down(const std::string& words) {
  down_ = words;
  stop_sync();
  waiting_.clear();
  in_socket_.clear();
  on_bus_.reset();
  frame_ends_ = Time::max();
}

void SimulatedBus::run_until(Time until) {
  while (now_ < until) step(until);
}

void SimulatedBus::hold_up_until(Time until) {
  while (now_ < until) {
    if (const auto received = step(until)) in_socket_.push_back(*received);
  }
}

void SimulatedBus::suspend_until(Time until) {
  const Time begin = now_;
  const std::optional<Time> sync = std::exchange(sync_period_, std::nullopt);
  run_until(until);
  suspended_ += now_ - begin;
  sync_period_ = sync;
  next_sync_ = std::max(next_sync_, now_);  // the kernel's timer has expired meanwhile
}

// ---- the bus ----

void SimulatedBus::put(const Frame& frame, Sender sender, bool is_own_sync) {
  if (down_ || (master_dead_ && sender == Sender::master)) return;
  Frame altered = frame;
  if (alter && !alter(altered, sender)) return;
  waiting_.push_back({altered, sender, is_own_sync});
}

void SimulatedBus::put_all(Frames& frames) {
  for (const Frame& frame : frames) put(frame, Sender::slaves);
  frames.clear();
}

std::optional<ReceivedFrame> SimulatedBus::step(Time until) {
  begin_frame();
  const Time sync = sync_period_ ? next_sync_ : Time::max();
  const Time slaves = std::max(slaves_.deadline(), now_);
  const Time next = std::min({frame_ends_, sync, slaves, until});
  now_ = std::max(now_, next);
  if (sync <= now_) {
    next_sync_ += *sync_period_;
    put(canopen::kSync, Sender::master, true);
  }
  Frames frames;
  slaves_.on_time(now_, frames);
  put_all(frames);
  return frame_ends_ <= now_ ? deliver() : std::nullopt;
}

// Arbitration: of equal identifiers the one that waits longest.
void SimulatedBus::begin_frame() {
  if (on_bus_ || waiting_.empty()) return;
  const auto first = std::ranges::min_element(waiting_, {}, [](const Waiting& one) { return one.frame.id; });
  on_bus_ = *first;
  waiting_.erase(first);
  const Time time = time_on_bus(on_bus_->frame);
  busy_ += time;
  frame_ends_ = now_ + time;
}

std::optional<ReceivedFrame> SimulatedBus::deliver() {
  const Waiting done = *std::exchange(on_bus_, std::nullopt);
  frame_ends_ = Time::max();
  log_.push_back({now_, done.frame, done.sender});
  if (done.sender == Sender::slaves) return ReceivedFrame{done.frame, now_};
  Frames frames;
  slaves_.on_frame(done.frame, now_, frames);
  put_all(frames);
  if (done.is_own_sync || done.sender == Sender::other) return ReceivedFrame{done.frame, now_};
  return std::nullopt;
}

}  // namespace kenaf::candrives
