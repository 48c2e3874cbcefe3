#include "relayd/commander_session.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "relayd/command_transform.hpp"

namespace kenaf::relayd {

namespace {

double seconds(CommanderSession::Duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

void CommanderSession::on_datagram(const protocol::relay::Datagram& datagram, const Peer& from, TimePoint now) {
  if (const auto* command = std::get_if<protocol::relay::Command>(&datagram)) take(*command, from, now);
  if (const auto* hello = std::get_if<protocol::relay::Hello>(&datagram)) take(*hello, from, now);
  if (const auto* ping = std::get_if<protocol::relay::Ping>(&datagram)) take(*ping, from, now);
  if (const auto* bye = std::get_if<protocol::relay::Bye>(&datagram)) take(*bye, from, now);
}

bool CommanderSession::is_commander(std::uint64_t session, const Peer& from) {
  if (phase_ == Phase::none || session != hello_.session) return false;
  if (from.address == commander_.address) return true;
  if (const auto held_back = log_stranger_.allow()) {
    spdlog::warn("{} sends in the session of {}: ignored ({} more before)", to_text(from.address),
                 to_text(commander_.address), *held_back);
  }
  return false;
}

void CommanderSession::take(const protocol::relay::Hello& hello, const Peer& from, TimePoint now) {
  // A bad Hello is refused, but no faster than the limiter allows: the sender may be forged.
  if (const char* wrong = out_of_range(hello)) {
    if (answers_to_strangers_.allow(now))
      refuse(hello.session, from, protocol::relay::RefusedReason::bad_request, wrong);
    return;
  }

  // While a session is open, its commander's Hello is a repetition, answered again once the world is ready; any other
  // Hello is refused.
  if (is_open()) {
    if (hello.session != hello_.session || from.address != commander_.address) {
      if (!answers_to_strangers_.allow(now)) return;
      refuse(
          hello.session, from, protocol::relay::RefusedReason::busy,
          fmt::format("{} has commanded the robot for {:.1f} s", to_text(commander_.address), seconds(now - opened_)));
      return;
    }
    commander_ = from;
    heard_ = now;
    if (phase_ == Phase::opening) return tell_of_slow_world(now);
    send_welcome();
    send_state(now);
    return;
  }

  // A Hello of a session that has just ended is a late copy and must not reopen it.
  const auto is_late_copy = [&](const Ended& ended) {
    return ended.session == hello.session && now - ended.when < kForgetEnded;
  };
  if (std::ranges::any_of(ended_, is_late_copy)) {
    if (answers_to_strangers_.allow(now))
      refuse(hello.session, from, protocol::relay::RefusedReason::unknown_session, "this session is over");
    return;
  }

  // A new session: all counts start here. The world is asked; on_world_ready() continues.
  phase_ = Phase::opening;
  hello_ = hello;
  commander_ = from;
  opened_ = heard_ = sent_ = now;
  state_ = {};
  state_.session = hello.session;
  late_before_ = late_counted_here_ = 0;
  stopped_by_silence_ = false;
  port_.open_world(hello_);
}

// So that a commander that waits less long than the world server may take knows whom it waits for. The session still
// begins once the world is ready.
void CommanderSession::tell_of_slow_world(TimePoint now) {
  if (now - opened_ < kWorldIsSlow || !answers_to_strangers_.allow(now)) return;
  refuse(
      hello_.session, commander_, protocol::relay::RefusedReason::no_world_server,
      fmt::format("its world server has not answered for {:.1f} s; is it loading, or hung?", seconds(now - opened_)));
}

void CommanderSession::on_world_ready(const WorldReady& ready, TimePoint now) {
  if (phase_ != Phase::opening) return;
  phase_ = Phase::active;
  heard_ = now;
  welcome_ = {hello_.session, ready.robot_time_s, ready.period_s, ready.lockstep};
  spdlog::info("{} commands the robot: period {} s{}", to_text(commander_.address), ready.period_s,
               ready.lockstep ? ", lock step" : "");
  send_welcome();
}

void CommanderSession::on_frame(const WorldFrame& frame, TimePoint now) {
  if (phase_ != Phase::active) return;
  const bool first = state_.robot.frame == 0;
  if (first) {
    late_before_ = frame.state.late_commands;
    commanded_s_ = frame.state.robot_time_s;
  }
  // The first frame is 1; if the world restarts its count, States continue theirs. A repeated number is no new frame:
  // the world reports that it was paused or resumed.
  if (first || frame.number + frame_offset_ < state_.robot.frame) frame_offset_ = state_.robot.frame + 1 - frame.number;

  state_.robot = frame.state;
  state_.world_paused = frame.paused;
  state_.not_at_start = frame.not_at_start;
  state_.robot.frame = static_cast<std::uint32_t>(frame.number + frame_offset_);
  world_counts_late_ = frame.numbered;
  state_.robot.late_commands = late_counted_here_ + (frame.numbered ? frame.state.late_commands - late_before_ : 0);

  commanded_s_ = std::min(commanded_s_, state_.robot.robot_time_s);  // a reset sets robot time back
  if (!stopped_by_silence_ && state_.robot.robot_time_s - commanded_s_ > hello_.command_timeout_s) {
    stopped_by_silence_ = true;
    port_.stop_robot();
    spdlog::warn("no command from {} for {} s of robot time: robot stopped", to_text(commander_.address),
                 hello_.command_timeout_s);
  }
  if (stopped_by_silence_) state_.robot.stopped_by_silence = true;
  send_state(now);
}

void CommanderSession::take(const protocol::relay::Command& command, const Peer& from, TimePoint now) {
  if (!is_commander(command.session, from)) {
    if ((command.session != hello_.session || phase_ == Phase::none) && answers_to_strangers_.allow(now)) {
      refuse(command.session, from, protocol::relay::RefusedReason::unknown_session,
             "the relay does not know this session; begin a new one with Hello");
    }
    return;
  }
  heard_ = now;
  if (phase_ == Phase::lost) send_state(now);
  if (phase_ != Phase::active || command.sequence < state_.acknowledged) return;
  if (command.sequence == state_.acknowledged) {
    send_state(now);  // the State that acknowledges it was lost, or is still to come
    return;
  }
  if (const char* wrong = out_of_range(command)) {
    if (const auto held_back = log_range_.allow(now)) {
      spdlog::warn("command {} of {} refused: {} ({} more before)", command.sequence, to_text(from.address), wrong,
                   *held_back);
    }
    refuse(command.session, from, protocol::relay::RefusedReason::bad_request, wrong);
    return;
  }
  if (command.frame > state_.robot.frame) {
    if (const auto held_back = log_future_.allow(now)) {
      spdlog::warn("command {} of {} answers frame {}, which was not sent yet: ignored ({} more before)",
                   command.sequence, to_text(from.address), command.frame, *held_back);
    }
    return;
  }
  accept(command);
}

void CommanderSession::accept(const protocol::relay::Command& command) {
  if (!world_counts_late_ && command.frame < state_.robot.frame) ++late_counted_here_;
  state_.acknowledged = command.sequence;
  commanded_s_ = state_.robot.robot_time_s;
  stopped_by_silence_ = false;
  port_.drive(command, command.frame == 0 ? std::nullopt : std::optional(command.frame - frame_offset_));
}

void CommanderSession::take(const protocol::relay::Ping& ping, const Peer& from, TimePoint now) {
  if (!is_commander(ping.session, from)) {
    if ((ping.session != hello_.session || phase_ == Phase::none) && answers_to_strangers_.allow(now)) {
      refuse(ping.session, from, protocol::relay::RefusedReason::unknown_session,
             "the relay does not know this session");
    }
    return;
  }
  heard_ = now;
  if (phase_ == Phase::active && !port_.ping_world(ping.id)) on_pong(ping.id, now);
}

void CommanderSession::on_pong(std::uint32_t id, TimePoint) {
  if (phase_ == Phase::active) port_.send(commander_, protocol::relay::Pong{hello_.session, id});
}

void CommanderSession::take(const protocol::relay::Bye& bye, const Peer& from, TimePoint now) {
  if (is_commander(bye.session, from)) end("said goodbye", now);
}

void CommanderSession::on_world_lost(std::string_view why, TimePoint now) {
  if (phase_ == Phase::opening) {
    refuse(hello_.session, commander_, protocol::relay::RefusedReason::no_world_server, why);
    phase_ = Phase::none;
  } else if (phase_ == Phase::active) {
    end("lost the world server", now);
    phase_ = Phase::lost;
    state_.world_server_lost = true;
    send_state(now);
  }
}

void CommanderSession::on_time(TimePoint now, bool world_is_alive) {
  if (phase_ == Phase::opening && now - opened_ >= kWorldMustOpenIn) {
    refuse(hello_.session, commander_, protocol::relay::RefusedReason::no_world_server,
           "the world server did not begin the session");
    end("could not begin", now);
  }
  if (phase_ != Phase::none && phase_ != Phase::opening && now - heard_ >= kSilenceEndsSession) {
    end("fell silent", now);
  }
  if (phase_ == Phase::active && now - sent_ >= kHeartbeat) {
    if (world_is_alive) send_state(now);
    sent_ = now;
  }
  if (phase_ == Phase::lost && now - sent_ >= kLostResend) send_state(now);
}

void CommanderSession::shut_down(TimePoint now) {
  if (!is_open()) return;
  refuse(hello_.session, commander_, protocol::relay::RefusedReason::unknown_session, "the relay is shutting down");
  end("is left alone: the relay ends", now);
}

std::optional<CommanderSession::TimePoint> CommanderSession::next_deadline() const {
  switch (phase_) {
    case Phase::none:
      return std::nullopt;
    case Phase::opening:
      return opened_ + kWorldMustOpenIn;
    case Phase::active:
      return std::min(heard_ + kSilenceEndsSession, sent_ + kHeartbeat);
    case Phase::lost:
      return std::min(heard_ + kSilenceEndsSession, sent_ + kLostResend);
  }
  return std::nullopt;
}

void CommanderSession::end(std::string_view why, TimePoint now) {
  if (is_open()) {
    ended_[next_ended_++ % ended_.size()] = {hello_.session, now};
    spdlog::info("{} {}: session over after {:.1f} s", to_text(commander_.address), why, seconds(now - opened_));
    port_.close_world();
  }
  phase_ = Phase::none;
}

void CommanderSession::refuse(std::uint64_t session, const Peer& to, protocol::relay::RefusedReason reason,
                              std::string_view text) {
  protocol::relay::Refused refused{session, reason, {}, std::min(text.size(), protocol::relay::kMaxReasonBytes)};
  std::copy_n(text.begin(), refused.text_length, refused.text.begin());
  port_.send(to, refused);
}

void CommanderSession::send_welcome() {
  port_.send(commander_, welcome_);
}

void CommanderSession::send_state(TimePoint now) {
  sent_ = now;
  if (state_.robot.frame != 0 || phase_ == Phase::lost) port_.send(commander_, state_);
}

}  // namespace kenaf::relayd
