#include "libkenaf_real/can_transport.hpp"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include "can/canbus/bus_layout.hpp"
#include "can/canbus/robot_bus.hpp"
#include "hrt/error.hpp"
#include "hrt/warnings.hpp"
#include "libkenaf_real/bus_cycle.hpp"
#include "libkenaf_real/commissioning.hpp"
#include "libkenaf_real/drive_targets.hpp"
#include "libkenaf_real/drive_watches.hpp"
#include "libkenaf_real/measured_state.hpp"
#include "libkenaf_real/power.hpp"
#include "libkenaf_real/real_time.hpp"
#include "libkenaf_real/translated_errors.hpp"
#include "robot/state.hpp"

namespace kenaf::real {
namespace {

using hrt::Error;
using hrt::joined;

// The heading bias is learnt during this time, while the robot stands; also the time after which it counts as standing.
constexpr double kStand_s = 0.5;
constexpr double kGaugeTolerance = 0.05;  // spread due to the width of the belts

canbus::RobotBus read_description(const hrt_config& config) {
  canbus::RobotBus bus = canbus::load_robot_bus(config.robot);
  if (config.can_interface[0] != '\0') bus.interface = config.can_interface;
  check_period(bus, config.period_s);
  return bus;
}

// Turns depend on the gauge and, without posture, the heading too.
std::string warning_of_gauge(const canbus::RobotBus& robot, double configured_mm) {
  const double described_mm = 1e3 * robot.track_gauge_m;
  if (described_mm <= 0 || std::abs(configured_mm - described_mm) <= kGaugeTolerance * described_mm) return {};
  return fmt::format(
      "track_gauge_mm is {:.0f}, but the robot's description has tracks that are {:.0f} mm apart "
      "(left_center_m): turns come out wrong",
      configured_mm, described_mm);
}

// After the stand of the opening. Only a warning: the rate may be that of a robot that somebody turned meanwhile.
std::string warning_of_gyro(const canbus::RobotBus& robot, const MeasuredState& measured) {
  const std::optional<double> rate_radps = measured.unlearnt_gyro_radps();
  if (!robot.gyro || !rate_radps) return {};
  return fmt::format(
      "{} measured {:.2f} rad/s while the tracks stood, too much to be taken for its bias: the heading may drift by "
      "that; "
      "leave the robot still while it is opened, or check units_per_radps, first_bit and bits in [can.gyro], or the "
      "gyro",
      to_string(NamedNode{robot.gyro->node, "gyro"}), *rate_radps);
}

// The warnings of all cases, since no cycle is to allocate: what the start has found, with and without a silent sensor.
using Warnings = std::array<std::string, 3>;  // by MeasuredState::Silence
Warnings warnings_with(const std::string& of_start, const canbus::RobotBus& robot) {
  const auto silent = [&](canopen::NodeId node, std::string_view name) {
    return joined(fmt::format("{} is silent: no posture, and the heading is that of the tracks",
                              to_string(NamedNode{node, name})),
                  of_start);
  };
  if (!robot.inclinometer || !robot.gyro) return {of_start, of_start, of_start};
  return {of_start, silent(robot.inclinometer->node, "inclinometer"), silent(robot.gyro->node, "gyro")};
}

std::size_t doubted_drives(const ProcessImage& image, const canbus::RobotBus& robot) {
  std::size_t doubted = 0;
  for (std::size_t i = 0; i < robot.drives.size(); ++i) doubted += image.drive(i).velocity_doubted ? 1 : 0;
  return doubted;
}

std::string doubts_in_words(const ProcessImage& image, const canbus::RobotBus& robot) {
  std::string words;
  for (std::size_t i = 0; i < robot.drives.size(); ++i) {
    if (!image.drive(i).velocity_doubted) continue;
    words =
        joined(words, fmt::format("{}: its velocity (object 0x606C) runs against its position, whose change is "
                                  "taken{}",
                                  to_string(drive_node(robot, i)),
                                  canbus::advice(robot.drives[i].device, "velocity = \"magnitude\" (or \"16 bits\")")));
  }
  return words;
}

}  // namespace

struct CanTransport::Session {
  Session(const hrt_config& config, const OpenBus& open_bus)
      : robot(read_description(config)),
        period_s(config.period_s),
        bus(open_bus(robot.interface, canbus::ids_to_hear(robot))),
        master(*bus, robot.master, to_time(robot.master_heartbeat_s), to_time(robot.answer_s)),
        cycle(master, robot, period_s) {}

  ~Session() { end_opening(); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void end_opening() {
    if (of_opener) give_back(*std::exchange(of_opener, std::nullopt));
  }

  canbus::RobotBus robot;
  double period_s;
  std::unique_ptr<canopen::Bus> bus;
  Master master;
  BusCycle cycle;
  std::string setup;  // for people
  std::string warning_of_start;
  std::size_t doubted = 0;  // drives whose velocity cannot be what it says
  Warnings warnings;
  std::optional<Scheduling> of_opener;  // before it opened in real time, until the cycles have a thread of their own
  std::optional<MeasuredState> measured;
  std::optional<DriveTargets> targets;
  // beats and late orders during the opening: reported with the first state after it
  std::uint32_t before = 0, late_before = 0;
  bool lost = true;  // until all drives are enabled there is nothing to stop in an orderly way
  std::atomic<double> round_trip_s = 0;
};

CanTransport::CanTransport(OpenBus open_bus) : open_bus_(std::move(open_bus)) {}
CanTransport::~CanTransport() = default;

hrt::Connection CanTransport::open(const hrt_config& config) {
  try {
    return with_translated_errors([&] { return set_up(config); });
  } catch (const OtherMaster& error) {
    throw Error(HRT_E_REFUSED, error.what());  // the other one was first
  }
}

hrt::Connection CanTransport::set_up(const hrt_config& config) {
  session_ = std::make_unique<Session>(config, open_bus_);
  Session& s = *session_;
  check_real_time(s.robot);
  if (s.robot.realtime_priority) {
    s.of_opener = scheduling_of_caller();
    begin_real_time(s.robot);
  }
  NodeFacts facts = commission(s.master, s.robot, s.period_s, config.can_timeout_s);
  s.master.watch_pauses(to_time(s.robot.master_silence_s));
  s.cycle.start();
  power_up(s.cycle);
  begin_event_timers(s.cycle, facts.watches, s.period_s);
  s.setup = describe_watches(s.robot, facts.watches, s.period_s) + "\n" + describe_real_time(s.robot);
  s.warning_of_start =
      joined(warning_of_gauge(s.robot, config.track_gauge_mm), warning_of_watches(s.robot, facts.watches));
  s.warnings = warnings_with(s.warning_of_start, s.robot);
  s.measured.emplace(s.robot, facts, s.period_s);
  s.targets.emplace(s.robot, s.cycle.sent());
  s.lost = false;
  for (double t_s = 0; t_s < kStand_s; t_s += s.period_s) {
    if (!measure()) throw Error(HRT_E_CLOSED, "hrt_close() was called while the robot was being set up");
    send({});
  }
  s.warning_of_start = joined(warning_of_gyro(s.robot, *s.measured), s.warning_of_start);
  s.warnings = warnings_with(joined(doubts_in_words(s.cycle.image(), s.robot), s.warning_of_start), s.robot);
  return {.period_s = s.period_s, .lockstep = false};
}

void CanTransport::prepare_cycles(std::thread::native_handle_type thread) {
  begin_real_time(thread, session_->robot);
}

void CanTransport::begin_cycles() {
  begin_real_time(session_->robot);
  session_->end_opening();
}

std::optional<robot::State> CanTransport::wait_state() {
  std::optional<robot::State> state = measure();
  if (!state) return state;
  Session& s = *session_;
  if (s.before == 0) {  // beats during the opening
    s.before = state->frame - 1;
    s.late_before = state->late_commands;
  }
  state->frame -= s.before;
  state->late_commands -= s.late_before;
  return state;
}

// A step of the loop. If control is lost, so is the robot; it is told to stop unless there is no bus to tell it by.
template <typename Step>
auto CanTransport::in_the_loop(Step step) {
  return with_translated_errors([&] {
    try {
      return step(*session_);
    } catch (const ControlLost&) {
      session_->lost = true;
      try_quick_stop(session_->cycle);
      throw;
    } catch (const canopen::BusError&) {
      session_->lost = true;
      throw;
    }
  });
}

std::optional<robot::State> CanTransport::measure() {
  return in_the_loop([](Session& s) -> std::optional<robot::State> {
    const std::optional<Beat> beat = s.cycle.wait();
    if (!beat) return std::nullopt;
    if (const std::optional<std::size_t> drive = s.cycle.lost_drive()) {
      s.lost = true;
      lose(s.cycle, *drive);
    }
    s.round_trip_s = s.cycle.round_trip_s();
    // the only cycles that allocate: those in which a drive's velocity turns out to be wrong, one for each such drive
    if (const std::size_t doubted = doubted_drives(s.cycle.image(), s.robot); doubted != s.doubted) {
      s.doubted = doubted;
      s.warnings = warnings_with(joined(doubts_in_words(s.cycle.image(), s.robot), s.warning_of_start), s.robot);
    }
    return s.measured->update(s.cycle, *beat);
  });
}

void CanTransport::send(const robot::Command& command) {
  in_the_loop([&](Session& s) { s.cycle.send(s.targets->step(command, s.cycle.image(), s.period_s)); });
}

void CanTransport::interrupt() {
  if (session_) session_->bus->interrupt();
}

void CanTransport::close() {
  if (!session_) return;
  const std::unique_ptr<Session> s = std::move(session_);
  std::optional<Error> not_stopped;
  const auto note = [&](int code, std::string_view what) {
    not_stopped =
        Error(code, fmt::format("closed, but not seen to stop: {}; without this program's heartbeat the drives "
                                "stop by themselves after {} s",
                                what, s->robot.master_silence_s));
  };
  const auto note_torque = [&](std::string_view what) {
    not_stopped = Error(HRT_E_DEVICE,
                        fmt::format("closed, and at rest, but not held with torque: {}; support the robot, which may "
                                    "sink or roll",
                                    what));
  };
  // A bus that is down takes no quick stop.
  const auto stop = [&] {
    try {
      const NotHeld not_held = power_down(s->cycle);
      if (!not_held.without_torque.empty()) note_torque(not_held.without_torque);
      if (!not_held.running.empty()) note(HRT_E_DEVICE, joined(not_held.running, not_held.without_torque));
    } catch (const Error&) {
      try_quick_stop(s->cycle);
      throw;
    }
  };
  try {
    if (!s->lost) with_translated_errors(stop);
  } catch (const Error& error) {
    note(error.code(), error.what());
  }
  s->master.stop_heartbeat();
  s->cycle.stop();
  if (not_stopped) throw *not_stopped;
}

const std::string& CanTransport::warning() const {
  if (!session_ || !session_->measured) return Transport::warning();
  return session_->warnings[static_cast<std::size_t>(session_->measured->silence())];
}

std::string CanTransport::setup() const {
  return session_ ? session_->setup : std::string();
}

double CanTransport::round_trip_s() const {
  return session_ ? session_->round_trip_s.load() : 0;
}

}  // namespace kenaf::real
