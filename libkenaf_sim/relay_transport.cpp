#include "libkenaf_sim/relay_transport.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "hrt/error.hpp"

namespace kenaf::sim {
namespace {

using hrt::Error;
using namespace std::chrono_literals;

constexpr auto kHelloEvery = 100ms;
// A killed commander keeps the robot until the relay has missed it for a second.
constexpr auto kBusyPatience = 1500ms;
// Commands are resent after 4 ms, then 8, 16, 32, 32 ...: quick recovery from loss, little traffic while the world is
// slow.
constexpr auto kFirstResend = 4ms;
constexpr auto kSlowestResend = 32ms;
// A first State that has not arrived this long after Welcome was lost.
constexpr auto kFirstStateResend = 20ms;
constexpr auto kPingEvery = 1000ms;
// The relay considers a commander gone after a second of silence.
constexpr auto kAliveEvery = 100ms;
// This thread checks its socket every 32 ms. A longer pause means that the process itself slept.
constexpr auto kLongestLook = 100ms;
// A world server that answers pings but counts no frame for this many link time-outs has stopped for good.
constexpr double kFrozenLinkTimeouts = 20;
constexpr int kByeCount = 3;
constexpr const char* kClosedWhileOpening = "closed while the robot was being opened";

template <typename Duration>
auto seconds(double value) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(value));
}

std::string words(const protocol::relay::Refused& refused) {
  return {refused.text.data(), std::min(refused.text_length, refused.text.size())};
}

}  // namespace

RelayTransport::RelayTransport(AskForAddresses ask)
    : ask_(std::move(ask)), interrupt_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (interrupt_ < 0) throw Error(HRT_E_INTERNAL, fmt::format("eventfd: {}", std::strerror(errno)));
}

RelayTransport::~RelayTransport() {
  close();
  ::close(interrupt_);
}

hrt::Connection RelayTransport::open(const hrt_config& config) {
  relay_ = config.relay;
  link_timeout_s_ = config.link_timeout_s;
  connect_timeout_s_ = config.connect_timeout_s;
  const Clock::time_point start = Clock::now();  // of connect_timeout_s, for everything until the first State
  const Clock::time_point deadline = start + seconds<Clock::duration>(connect_timeout_s_);
  std::optional<Addresses> found = look_up("relay", relay_, SOCK_DGRAM, deadline, interrupt_, ask_);
  if (!found) throw Error(HRT_E_CLOSED, kClosedWhileOpening);
  addresses_ = *std::move(found);
  connect_to(0);
  while (session_ == 0) {
    if (getrandom(&session_, sizeof session_, 0) < 0) {
      throw Error(HRT_E_INTERNAL, fmt::format("getrandom: {}", std::strerror(errno)));
    }
  }
  const hrt::Connection connection = greet({.session = session_,
                                            .period_s = config.period_s,
                                            .command_timeout_s = config.command_timeout_s,
                                            .lockstep = config.lockstep != 0,
                                            .reset_robot = config.reset_robot != 0},
                                           deadline);
  // Until the first State arrives, this stands in for its answer: the relay answers a Command with the newest State.
  command_ = {};
  command_.session = session_;
  command_.sequence = 1;
  const Clock::time_point now = Clock::now();
  resend_after_ = kFirstStateResend;
  resend_at_ = now + resend_after_;
  life_at_ = looked_at_ = ping_at_ = now;
  state_at_ = start;
  return connection;
}

void RelayTransport::connect_to(std::size_t number) {
  const Address& to = addresses_[number];
  if (socket_ >= 0) ::close(socket_);
  address_ = number;
  port_closed_ = false;
  socket_ = socket(to.address.ss_family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  // without a way to this address another one may have one
  if (socket_ >= 0 && connect(socket_, to.plain(), to.size) == 0) return;
  if (addresses_.size() == 1)
    throw Error(HRT_E_LINK, fmt::format("no way to the relay at {}: {}", relay_, std::strerror(errno)));
  port_closed_ = true;
}

void RelayTransport::connect_to_next() {
  connect_to((address_ + 1) % addresses_.size());
}

hrt::Connection RelayTransport::greet(const protocol::relay::Hello& hello, Clock::time_point deadline) {
  const Clock::time_point start = Clock::now();
  Clock::time_point hello_at = start;
  std::optional<protocol::relay::Refused> refused;
  // The relay listens on one of the addresses that its name has, such as 127.0.0.1 and ::1 of localhost. Each is asked
  // in turn: the next one at once if nobody listens, and after its share of the time if nobody answers.
  const Clock::duration share = end_of_share(start, deadline, addresses_.size()) - start;
  Clock::time_point next_address_at = start + share;
  std::size_t asked = 1;  // since the last pause
  for (;;) {
    const Clock::time_point now = Clock::now();
    if (refused && refused->reason == protocol::relay::RefusedReason::busy && now - start >= kBusyPatience) break;
    if (now >= deadline) break;
    if (!refused && now >= next_address_at) {
      connect_to_next();
      next_address_at = now + share;
      hello_at = now;
    }
    if (now >= hello_at) {
      transmit(hello);
      hello_at = now + kHelloEvery;
      asked = 1;
    }
    while (const std::optional<protocol::relay::Datagram> datagram = receive()) {
      if (const auto* welcome = std::get_if<protocol::relay::Welcome>(&*datagram);
          welcome && welcome->session == session_) {
        return {welcome->period_s, welcome->lockstep};
      }
      if (const auto* answer = std::get_if<protocol::relay::Refused>(&*datagram);
          answer && answer->session == session_) {
        refused = *answer;
        // Asking again does not change these.
        if (answer->reason == protocol::relay::RefusedReason::bad_request) {
          throw Error(HRT_E_REFUSED, fmt::format("the relay at {} refused: {}", relay_, words(*answer)));
        }
      }
    }
    if (!refused && port_closed_ && asked < addresses_.size()) {
      connect_to_next();
      next_address_at = now + share;
      ++asked;
      transmit(hello);
      continue;
    }
    if (!wait_readable(std::min(hello_at, deadline))) throw Error(HRT_E_CLOSED, kClosedWhileOpening);
  }
  if (!refused) {
    throw Error(HRT_E_LINK,
                fmt::format("no relay at {}{}; start kenaf-relayd, or set relay in kenaf.toml or KENAF_RELAY", relay_,
                            port_closed_ ? ": nothing listens there" : " answered"));
  }
  const bool no_world = refused->reason == protocol::relay::RefusedReason::no_world_server;
  throw Error(HRT_E_REFUSED, fmt::format("the relay at {} refused: {}{}", relay_, words(*refused),
                                         no_world ? "; start kenaf-world, or start it again" : ""));
}

std::optional<robot::State> RelayTransport::wait_state() {
  for (;;) {
    while (const std::optional<protocol::relay::Datagram> datagram = receive()) {
      if (std::optional<robot::State> state = take(*datagram)) return state;
    }
    const Clock::time_point now = Clock::now();
    check_life(now);
    send_what_is_due(now);
    if (!wait_readable(std::min(resend_at_, ping_at_))) return std::nullopt;
  }
}

std::optional<robot::State> RelayTransport::take(const protocol::relay::Datagram& datagram) {
  const Clock::time_point now = Clock::now();
  // Pong: only the answer to the newest ping gives the round trip.
  if (const auto* pong = std::get_if<protocol::relay::Pong>(&datagram)) {
    if (pong->session == session_ && pong->id == ping_id_) {
      round_trip_s_ = std::chrono::duration<double>(now - pinged_at_).count();
      life_at_ = now;
    }
    return std::nullopt;
  }

  // Refused: the relay ended this session.
  if (const auto* refused = std::get_if<protocol::relay::Refused>(&datagram)) {
    if (refused->session != session_) return std::nullopt;
    throw Error(HRT_E_LINK,
                fmt::format("the relay at {} ended the session: {}; call hrt_close(), then hrt_kenaf_init()", relay_,
                            words(*refused)));
  }

  // State: one of another session is late; if the relay has lost its world server, no newer one will come.
  const auto* state = std::get_if<protocol::relay::State>(&datagram);
  if (state == nullptr || state->session != session_) return std::nullopt;
  if (state->world_server_lost) {
    throw Error(HRT_E_LINK, fmt::format("the relay at {} lost its world server; once it is back, call hrt_close(), "
                                        "then hrt_kenaf_init()",
                                        relay_));
  }

  // A paused world sends no new frames and must not count as lost.
  is_paused_ = state->world_paused;
  not_at_start_ = state->not_at_start;
  if (is_paused_) state_at_ = life_at_ = now;

  // Only a newer frame begins a cycle: a repeated State, or one that was overtaken, is dropped.
  if (state->robot.frame <= frame_) return std::nullopt;
  frame_ = state->robot.frame;
  state_at_ = life_at_ = now;
  alive_at_ = now + kAliveEvery;
  return state->robot;
}

void RelayTransport::check_life(Clock::time_point now) {
  if (port_closed_) {
    throw Error(HRT_E_LINK, fmt::format("the relay at {} is gone: nothing listens there any more", relay_));
  }
  // Time during which this process slept (busy or suspended machine, debugger) is not silence of the link.
  const Clock::duration slept = std::max<Clock::duration>(now - looked_at_ - kLongestLook, Clock::duration::zero());
  state_at_ += slept;
  life_at_ += slept;
  looked_at_ = now;
  const auto silent_s = [&](Clock::time_point since) { return std::chrono::duration<double>(now - since).count(); };
  if (frame_ == 0) {
    if (silent_s(state_at_) <= connect_timeout_s_) return;
    throw Error(
        HRT_E_LINK,
        fmt::format(
            "the relay at {} accepted the session, but sent no state within {:.2f} s; is the world server stopped?",
            relay_, silent_s(state_at_)));
  }
  if (silent_s(life_at_) > link_timeout_s_) {
    throw Error(HRT_E_LINK, fmt::format("no state from the relay at {} for {:.2f} s; is the network, the relay or the "
                                        "world server down?",
                                        relay_, silent_s(life_at_)));
  }
  if (silent_s(state_at_) > kFrozenLinkTimeouts * link_timeout_s_) {
    throw Error(
        HRT_E_LINK,
        fmt::format("the world server behind the relay at {} answers, but its time has not advanced for {:.1f} s",
                    relay_, silent_s(state_at_)));
  }
}

void RelayTransport::send(const robot::Command& command) {
  command_ = {.session = session_, .sequence = command_.sequence + 1, .frame = frame_, .robot = command};
  const Clock::time_point now = Clock::now();
  // Before the command: if states come so fast that nobody ever waits, this measures the round trip, and the answer is
  // read before the state that ends the wait, not after the program's next computation.
  if (now >= ping_at_) ping(now);
  transmit(command_);
  resend_after_ = kFirstResend;
  resend_at_ = now + resend_after_;
  // Time spent by the program does not count against the link.
  state_at_ = life_at_ = looked_at_ = now;
}

// The previous command stays in force: the relay has it and takes the repetition as a sign of life.
void RelayTransport::keep_alive() {
  const Clock::time_point now = Clock::now();
  if (now < alive_at_) return;
  transmit(command_);
  alive_at_ = now + kAliveEvery;
}

void RelayTransport::send_what_is_due(Clock::time_point now) {
  if (now >= resend_at_) {
    transmit(command_);
    resend_after_ = std::min<Clock::duration>(2 * resend_after_, kSlowestResend);
    resend_at_ = now + resend_after_;
  }
  // A state is overdue: check whether the world server still lives. It answers pings even while its time stands still.
  const Clock::duration overdue = seconds<Clock::duration>(link_timeout_s_ / 4);
  const bool is_overdue = now - state_at_ >= overdue;
  if (now >= ping_at_ || (is_overdue && now - pinged_at_ >= overdue)) ping(now);
}

void RelayTransport::ping(Clock::time_point now) {
  ++ping_id_;
  pinged_at_ = now;
  ping_at_ = now + kPingEvery;
  transmit(protocol::relay::Ping{.session = session_, .id = ping_id_});
}

const std::string& RelayTransport::warning() const {
  static const std::string displaced =
      "the robot does not begin at the world's first start pose, which was not free, but at the next free one; "
      "another robot stands there";
  return not_at_start_ ? displaced : Transport::warning();
}

void RelayTransport::close() {
  if (socket_ < 0) return;
  // There is no acknowledgement, so one is not enough if packets get lost.
  for (int i = 0; session_ != 0 && i < kByeCount; ++i) transmit(protocol::relay::Bye{.session = session_});
  ::close(socket_);
  socket_ = -1;
  session_ = 0;
}

void RelayTransport::interrupt() {
  const std::uint64_t one = 1;
  // The write fails only if the eventfd's count would overflow, and then it is readable already.
  [[maybe_unused]] const ssize_t written = write(interrupt_, &one, sizeof one);
}

void RelayTransport::transmit(const protocol::relay::Datagram& datagram) {
  std::array<std::byte, protocol::relay::kMaxDatagramBytes> bytes;
  const std::size_t size = protocol::relay::encode(datagram, bytes);
  // A datagram that cannot be sent counts as lost: everything important is sent again. A closed port is reported by the
  // next call on the socket, which may be this one.
  if (::send(socket_, bytes.data(), size, MSG_NOSIGNAL) < 0 && errno == ECONNREFUSED) port_closed_ = true;
}

std::optional<protocol::relay::Datagram> RelayTransport::receive() {
  for (;;) {
    const ssize_t size = recv(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
    if (size < 0) {
      if (errno == EINTR) continue;
      if (errno == ECONNREFUSED) {
        port_closed_ = true;
        continue;
      }
      return std::nullopt;
    }
    port_closed_ = false;
    protocol::relay::Datagram datagram;
    if (protocol::relay::decode(std::span(buffer_).first(static_cast<std::size_t>(size)), datagram) ==
        protocol::DecodeError::none) {
      return datagram;
    }
  }
}

bool RelayTransport::wait_readable(Clock::time_point until) {
  const auto left = std::max<Clock::duration>(until - Clock::now(), Clock::duration::zero());
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(left);
  const timespec timeout{.tv_sec = static_cast<time_t>(whole.count()),
                         .tv_nsec = static_cast<long>(std::chrono::nanoseconds(left - whole).count())};
  std::array<pollfd, 2> watched{{{socket_, POLLIN, 0}, {interrupt_, POLLIN, 0}}};
  ppoll(watched.data(), watched.size(), &timeout, nullptr);
  return (watched[1].revents & POLLIN) == 0;
}

}  // namespace kenaf::sim
