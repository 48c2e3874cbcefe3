#include "can/candrives/service.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <thread>

namespace kenaf::candrives {

using canopen::BusError;
using canopen::PowerState;
using canopen::Time;

namespace {

constexpr Time kLookAround = std::chrono::milliseconds(50);  // period of checks of input and signals
constexpr Time kReopen = std::chrono::milliseconds(100);
constexpr Time kMuchTooLate = std::chrono::milliseconds(100);
constexpr double kMoves_mps = 0.001;

// The clock of canbus::SocketBus.
Time clock_now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

// States in which a drive stays; the others are only passed through.
bool is_worth_a_line(PowerState state) {
  return state == PowerState::switch_on_disabled || state == PowerState::operation_enabled ||
         state == PowerState::quick_stop_active || state == PowerState::fault;
}

template <typename... Args>
void say(fmt::format_string<Args...> format, Args&&... args) {
  fmt::print("kenaf-candrives: {}\n", fmt::format(format, std::forward<Args>(args)...));
  std::fflush(stdout);
}

template <typename... Args>
void warn(fmt::format_string<Args...> format, Args&&... args) {
  fmt::print(stderr, "kenaf-candrives: {}\n", fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace

Service::Service(const canbus::RobotBus& bus, Plant& plant, std::string where)
    : bus_(bus),
      plant_(&plant),
      where_(std::move(where)),
      start_(clock_now()),
      now_(start_),
      slaves_(bus, plant, start_),
      faults_(start_) {
  reported_.assign(bus.drives.size(), PowerState::switch_on_disabled);
}

void Service::plan(const PlannedFault& fault) {
  faults_.add(fault, now_);
}

void Service::run(const OpenBus& open, const std::atomic<bool>& stop) {
  std::unique_ptr<canopen::Bus> bus = open();
  bool first = true;
  while (!stop) {
    try {
      if (!bus) bus = open();
      if (!std::exchange(first, false)) warn("the bus is up again");
      serve(*bus, stop);
    } catch (const BusError& error) {
      if (bus) warn("{}; the nodes keep running and wait for the bus", error.what());
      bus.reset();
      live_without_bus();
    }
  }
}

void Service::serve(canopen::Bus& bus, const std::atomic<bool>& stop) {
  Frames out;
  bool said_up = now_ > start_;
  while (!stop) {
    const Time until = std::min({slaves_.deadline(), faults_.deadline(), clock_now() + kLookAround});
    const auto received = bus.receive(until);
    if (received) {
      up_to(received->at, &received->frame, out);
    } else {
      // not up to the current time: if this program was held up, earlier frames may have arrived since
      up_to(until, nullptr, out);
      read_input();
    }
    inject_due(out);
    for (const canopen::Frame& frame : std::exchange(out, {})) bus.send(frame);
    if (!std::exchange(said_up, true)) say("{} nodes on {}", slaves_.node_count(), where_);
    report_states();
  }
}

void Service::live_without_bus() {
  std::this_thread::sleep_for(kReopen);
  Frames lost;
  up_to(clock_now(), nullptr, lost);
  inject_due(lost);
  read_input();
  report_states();
}

// A frame's time stamp may lie before the time already served: time never goes back.
void Service::up_to(Time now, const canopen::Frame* frame, Frames& out) {
  const Time before = now_, began = clock_now();
  now_ = std::max(now_, now);
  if (frame != nullptr)
    slaves_.on_frame(*frame, now_, out);
  else
    slaves_.on_time(now_, out);
  const auto& speeds = plant_->state().track_mps;
  if (std::ranges::any_of(speeds, [](double speed) { return std::abs(speed) > kMoves_mps; })) faults_.on_motion(now_);
  watch_speed(before, began);
}

void Service::inject_due(Frames& out) {
  for (const Fault& fault : faults_.due(now_)) slaves_.inject(fault, now_, out);
}

// ---- the terminal ----

void Service::read_input() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  while (input_open_ && poll(&input, 1, 0) > 0) {
    char bytes[4096];
    const ssize_t count = read(STDIN_FILENO, bytes, sizeof bytes);
    if (count <= 0) {
      input_open_ = false;
      return;
    }
    input_.append(bytes, static_cast<std::size_t>(count));
    for (std::size_t end = input_.find('\n'); end != std::string::npos; end = input_.find('\n')) {
      const std::string line = input_.substr(0, end);
      input_.erase(0, end + 1);
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      try {
        plan(parse_fault(line, bus_));
        say("{:.3f} s: received: {}", std::chrono::duration<double>(clock_now() - start_).count(), line);
      } catch (const std::invalid_argument& error) {
        warn("{}", error.what());
      }
    }
    if (input_.size() > 1000) input_.clear();  // no fault text is this long
  }
}

void Service::report_states() {
  for (std::size_t i = 0; i < bus_.drives.size(); ++i) {
    const PowerState state = slaves_.drive(i).power_state();
    if (state == reported_[i] || !is_worth_a_line(state)) continue;
    reported_[i] = state;
    say("{:.3f} s: {} (node {}): {}", std::chrono::duration<double>(now_ - start_).count(), bus_.drives[i].name,
        bus_.drives[i].node, describe(state));
  }
}

// Lateness alone may be caused briefly by another program; the ratio shows whether it is ours.
void Service::watch_speed(Time before, Time began) {
  const Time ended = clock_now();
  spent_ += ended - began;
  simulated_ += now_ - before;
  if (said_slow_ || ended - now_ < kMuchTooLate || simulated_ == Time::zero()) return;
  said_slow_ = true;
  const double ratio = static_cast<double>(spent_.count()) / static_cast<double>(simulated_.count());
  warn("the simulation is {} ms behind real time: 1 s has taken {:.2f} s so far{}",
       std::chrono::duration_cast<std::chrono::milliseconds>(ended - now_).count(), ratio,
       ratio > 0.7 ? "; --time-step 0.004, or --ideal, needs less" : "");
}

}  // namespace kenaf::candrives
