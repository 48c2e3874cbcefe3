#include "relayd/relay.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/random.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <type_traits>
#include <variant>

#include "relayd/command_transform.hpp"

namespace kenaf::relayd {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kPingWorldEvery = 250ms;  // when it sends nothing by itself
constexpr auto kWorldIsAlive = 600ms;    // after a sign of life: two pings plus a margin
constexpr auto kWorldIsLost = 2s;        // extended: not even a ping was answered
constexpr auto kPlainWorldIsLost = 5s;   // plain: it may be paused without being able to say so
constexpr std::size_t kMostPending = 1 << 18;
constexpr std::int64_t kOwnPing = -1;  // the id of the relay's own pings; a commander's are not negative

// 128 random bits: no other client can take this relay's robot away.
RobotPlacement with_own_key(RobotPlacement placement) {
  std::array<unsigned char, 16> key;
  if (::getrandom(key.data(), key.size(), 0) != static_cast<ssize_t>(key.size())) {
    throw std::runtime_error("the system provides no random numbers for the relay's key");
  }
  for (const unsigned char byte : key) placement.owner += fmt::format("{:02x}", byte);
  return placement;
}

}  // namespace

Relay::Relay(const RelayOptions& options)
    : options_(options),
      udp_(open_udp(options.listen, address_)),
      link_(options.world_server, with_own_key(options.placement), events_) {
  out_.reserve(4096);
  if (!is_loopback(address_)) {
    spdlog::warn("listening on {}: any program that reaches this address can drive the robot", to_text(address_));
  }
}

void Relay::run() {
  std::thread receiver(&Relay::receive_commands, this);
  std::thread link(&WorldLink::run, &link_, std::cref(threads_end_));
  while (true) {
    timekeeper_waker_.clear();
    if (threads_end_) break;  // looked at after clear(), which would discard the wake-up of shut_down()
    attend();
    wait_for_alarm();
  }
  receiver.join();
  link.join();
  world_.reset();
}

void Relay::stop() {
  stopping_ = true;
  timekeeper_waker_.wake();
}

void Relay::shut_down() {
  session_.shut_down(Clock::now());
  if (world_) write_stop(out_);
  flush();
  if (world_ && !out_.empty()) {
    pollfd writable{world_->socket->get(), POLLOUT, 0};
    ::poll(&writable, 1, 200);
    flush();
  }
  threads_end_ = true;
  receiver_waker_.wake();
  link_.waker().wake();
  timekeeper_waker_.wake();
}

// --- receiver

void Relay::receive_commands() {
  std::array<pollfd, 2> watched{{{udp_.get(), POLLIN, 0}, {receiver_waker_.fd(), POLLIN, 0}}};
  while (!threads_end_) {
    Peer from;
    if (const auto bytes = receive_from(udp_.get(), received_, from)) {
      take_datagram(*bytes, from);
    } else {
      ::poll(watched.data(), watched.size(), -1);
    }
  }
}

void Relay::take_datagram(std::size_t bytes, const Peer& from) {
  const protocol::DecodeError error = protocol::relay::decode({received_.data(), bytes}, arrival_.datagram);
  const bool for_the_relay = std::visit(
      [](const auto& datagram) {
        using Kind = std::decay_t<decltype(datagram)>;
        return std::is_same_v<Kind, protocol::relay::Hello> || std::is_same_v<Kind, protocol::relay::Command> ||
               std::is_same_v<Kind, protocol::relay::Ping> || std::is_same_v<Kind, protocol::relay::Bye>;
      },
      arrival_.datagram);
  if (error != protocol::DecodeError::none || !for_the_relay) {
    if (const auto held_back = log_malformed_.allow()) {
      spdlog::warn("{} bytes from {} ignored: {} ({} more before)", bytes, to_text(from.address),
                   error == protocol::DecodeError::none ? "only a relay sends this kind" : protocol::describe(error),
                   *held_back);
    }
    return;
  }
  arrival_.from = from;
  if (!arrivals_.put(arrival_)) {
    if (const auto held_back = log_overflow_.allow()) {
      spdlog::warn("datagrams arrive faster than the relay can handle them: one dropped ({} more before)", *held_back);
    }
  }
}

// --- decision

void Relay::decide() {
  if (threads_end_) return;
  if (stopping_) return shut_down();
  take_mail();
  const TimePoint now = Clock::now();
  watch_world(now);
  session_.on_time(now, world_ && now - world_heard_ < kWorldIsAlive);
  flush();
  set_alarm(now);
}

void Relay::take_mail() {
  events_.take_all([this](WorldEvent& event) {
    std::visit([this](const auto& kind) { take(kind); }, event);
    event = WorldPong{};  // releases a socket now, not when its queue slot is reused
  });
  arrivals_.take_all([this](Arrival& arrival) { session_.on_datagram(arrival.datagram, arrival.from, Clock::now()); });
}

void Relay::take(const WorldFrame& frame) {
  if (!world_) return;
  world_heard_ = Clock::now();
  newest_.robot_time_s = frame.state.robot_time_s;
  if (frame.interval_s > 0) newest_.period_s = frame.interval_s;
  session_.on_frame(frame, world_heard_);
}

void Relay::take(const WorldPong& pong) {
  if (!world_) return;
  world_heard_ = Clock::now();
  if (pong.id >= 0) session_.on_pong(static_cast<std::uint32_t>(pong.id), world_heard_);
}

void Relay::take(const SessionAnswer& answer) {
  if (!world_) return;
  world_heard_ = Clock::now();
  if (unanswered_sessions_ == 0 || --unanswered_sessions_ > 0) return;
  if (answer.refusal.empty()) {
    session_.on_world_ready(answer.ready, world_heard_);
  } else {
    spdlog::warn("the world server refused the session: {}", answer.refusal);
    session_.on_world_lost("the world server refused the session: " + answer.refusal, world_heard_);
  }
}

void Relay::take(const LinkUp& up) {
  if (up.request != wanted_link_) return;
  world_ = up;
  unanswered_sessions_ = 0;  // answers still due from the last connection were lost with it
  world_heard_ = world_pinged_ = Clock::now();
  spdlog::info("connected to the world server at {}:{}{}", options_.world_server.host, options_.world_server.port,
               up.extended ? "" : ", a plain USARSim server: no lock step, its own rate");
  if (session_.is_opening()) {
    session_.on_world_ready(up.ready, world_heard_);
  } else {
    close_world();  // the request is no longer wanted
  }
}

void Relay::take(const LinkDown& down) {
  if (down.request != wanted_link_) return;
  world_.reset();
  out_.clear();
  session_.on_world_lost(down.why, Clock::now());
}

// A broken connection shows itself; a silent one has to be asked.
void Relay::watch_world(TimePoint now) {
  if (!world_) return;
  const auto silence = now - world_heard_;
  if (silence > (world_->extended ? kWorldIsLost : kPlainWorldIsLost)) {
    leave_world("it does not answer", now);
  } else if (out_.size() > kMostPending) {
    leave_world("it accepts no more data", now);
  } else if (world_->extended && silence >= kPingWorldEvery && now - world_pinged_ >= kPingWorldEvery) {
    world_pinged_ = now;
    write_ping(out_, kOwnPing);
  }
}

void Relay::leave_world(std::string_view why, TimePoint now) {
  const std::string words =
      fmt::format("lost the world server at {}:{}: {}", options_.world_server.host, options_.world_server.port, why);
  spdlog::warn("{}; reconnecting", words);
  request_link({});
  session_.on_world_lost(words, now);
}

// Wakes the timekeeper only if it would be late: each message moves its deadline on, and it finds that when it wakes.
void Relay::set_alarm(TimePoint now) {
  Alarm alarm;
  alarm.at = session_.next_deadline().value_or(TimePoint::max());
  if (world_) alarm.at = std::min(alarm.at, now + kPingWorldEvery);
  if (world_ && !out_.empty()) alarm.writable = world_->socket;
  const std::lock_guard lock(alarm_mutex_);
  if (alarm.at < waiting_for_.at || (alarm.writable && alarm.writable != waiting_for_.writable))
    timekeeper_waker_.wake();
  alarm_ = std::move(alarm);
}

void Relay::flush() {
  if (!world_) out_.clear();
  if (out_.empty()) return;
  const ssize_t sent = ::send(world_->socket->get(), out_.data(), out_.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  if (sent >= 0) {
    out_.erase(0, static_cast<std::size_t>(sent));
  } else if (errno != EAGAIN && errno != EINTR) {
    out_.clear();  // broken; the link's thread notices it too and reports the reason
  }
}

void Relay::request_link(const WorldSession& session) {
  world_.reset();
  out_.clear();
  unanswered_sessions_ = 0;
  if (link_.requests().put({wanted_link_ + 1, session})) ++wanted_link_;
}

// --- timekeeper

void Relay::wait_for_alarm() {
  Alarm alarm;
  {
    const std::lock_guard lock(alarm_mutex_);
    alarm = waiting_for_ = alarm_;
  }
  std::array<pollfd, 2> watched{{{timekeeper_waker_.fd(), POLLIN, 0}, {-1, POLLOUT, 0}}};
  if (alarm.writable) watched[1].fd = alarm.writable->get();
  const bool is_set = alarm.at != TimePoint::max();
  timespec timeout{};
  if (is_set) {
    const auto left = std::max(alarm.at - Clock::now(), Clock::duration::zero());
    timeout.tv_sec = std::chrono::duration_cast<std::chrono::seconds>(left).count();
    timeout.tv_nsec = std::chrono::nanoseconds(left % 1s).count();
  }
  ::ppoll(watched.data(), watched.size(), is_set ? &timeout : nullptr, nullptr);
}

// --- requests of the session

void Relay::send(const Peer& to, const protocol::relay::Datagram& datagram) {
  std::array<std::byte, protocol::relay::kMaxDatagramBytes> bytes;
  const std::size_t size = protocol::relay::encode(datagram, bytes);
  // A datagram that cannot be sent counts as lost, which the protocol tolerates.
  send_to(udp_.get(), is_ipv4(address_) ? AF_INET : AF_INET6, std::span(bytes).first(size), to);
}

void Relay::open_world(const protocol::relay::Hello& hello) {
  const WorldSession wanted{hello.period_s, hello.lockstep, hello.command_timeout_s};
  if (!world_ || hello.reset_robot) {
    request_link(wanted);  // leaving and re-entering the world puts the robot back
  } else if (world_->extended) {
    write_world_session(out_, wanted);
    ++unanswered_sessions_;
    flush();
  } else {
    newest_.lockstep = false;
    session_.on_world_ready(newest_, Clock::now());
  }
}

void Relay::close_world() {
  if (!world_) return;
  write_stop(out_);
  if (world_->extended) {
    write_world_session(out_, {});
    ++unanswered_sessions_;
  }
  flush();
}

void Relay::drive(const protocol::relay::Command& command, std::optional<std::int64_t> world_frame) {
  if (!world_) return;
  write_command(out_, command, world_->wheel_radius_m, world_->extended ? world_frame : std::nullopt);
  flush();
}

void Relay::stop_robot() {
  write_stop(out_);
  flush();
}

bool Relay::ping_world(std::uint32_t id) {
  if (!world_ || !world_->extended) return false;
  write_ping(out_, id);
  flush();
  return true;
}

}  // namespace kenaf::relayd
