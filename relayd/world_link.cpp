#include "relayd/world_link.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <thread>

namespace kenaf::relayd {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kConnectWithin = 2s;
constexpr auto kLeaveWithin = 500ms;
constexpr std::chrono::milliseconds kFirstPause = 50ms;
constexpr std::chrono::milliseconds kLongestPause = 1s;

// The few lines of a handshake always fit a new socket's buffer.
void send_whole(int fd, const std::string& text) {
  if (text.empty()) return;
  const ssize_t sent = ::send(fd, text.data(), text.size(), MSG_NOSIGNAL);
  if (sent != static_cast<ssize_t>(text.size())) {
    throw std::runtime_error(sent < 0 ? std::strerror(errno) : "it accepts no more data");
  }
}

// Closes, and waits until the server has closed too: then the robot is out of the world and its place is free.
void leave(int fd) {
  ::shutdown(fd, SHUT_WR);
  std::array<char, 4096> rest;
  pollfd watched{fd, POLLIN, 0};
  const auto until = Clock::now() + kLeaveWithin;
  while (Clock::now() < until && ::poll(&watched, 1, poll_timeout(until)) > 0) {
    if (::recv(fd, rest.data(), rest.size(), MSG_DONTWAIT) <= 0) return;
  }
}

}  // namespace

struct WorldLink::Connection {
  std::shared_ptr<Descriptor> socket;
  WorldHandshake handshake;
  bool handed_over = false;
  SensorTransform transform{};
  protocol::usarsim::LineSplitter lines{};
  std::string out{};
};

WorldLink::WorldLink(const protocol::HostPort& server, const RobotPlacement& placement, WorldEvents& events)
    : server_(server), placement_(placement), events_(events) {}

void WorldLink::run(const std::atomic<bool>& stopping) {
  stopping_ = &stopping;
  std::string reported;
  std::chrono::milliseconds pause = kFirstPause;
  while (!stopping) {
    was_up_ = false;
    std::string why;
    try {
      why = serve(stopping);
    } catch (const std::exception& error) {
      why = error.what();
    }
    if (stopping) return;
    if (take_requests() || why.empty()) {  // the failure does not concern the newer request
      pause = kFirstPause;
      continue;
    }
    if (was_up_) pause = kFirstPause;
    why = fmt::format("no world server at {}:{}: {}", server_.host, server_.port, why);
    if (was_up_ || why != reported) spdlog::warn("{}; trying again", why);
    reported = why;
    put(LinkDown{request_.number, why});

    pollfd woken{waker_.fd(), POLLIN, 0};
    const auto until = Clock::now() + pause;
    while (!take_requests() && !stopping && Clock::now() < until) ::poll(&woken, 1, poll_timeout(until));
    pause = std::min(2 * pause, kLongestPause);
  }
}

// Serves one connection from beginning to end. Returns or throws the reason for its end; empty: a new one was
// requested, or the relay stops.
std::string WorldLink::serve(const std::atomic<bool>& stopping) {
  // Resolves the name and connects; a newer request or the end of the relay interrupts both.
  take_requests();
  if (stopping) return {};
  const auto deadline = Clock::now() + kConnectWithin;
  const auto endpoints = lookup_.find(server_, deadline, waker_.fd());
  if (!endpoints) return {};
  std::optional<Descriptor> socket = connect_tcp(*endpoints, deadline, waker_.fd());
  if (!socket) return {};
  Connection connection{std::make_shared<Descriptor>(std::move(*socket)),
                        WorldHandshake(placement_, request_.session, Clock::now())};
  std::array<char, 65536> bytes;
  std::array<pollfd, 2> watched{{{connection.socket->get(), POLLIN, 0}, {waker_.fd(), POLLIN, 0}}};

  // Until the handshake is complete, poll() ends at its deadline; afterwards only the socket or the waker ends it.
  while (true) {
    const bool shaking = !connection.handed_over;
    if (::poll(watched.data(), watched.size(), shaking ? poll_timeout(connection.handshake.deadline()) : -1) < 0 &&
        errno != EINTR) {
      return std::strerror(errno);
    }

    // On a newer request or at the end: leave, so that the robot is out of the world before the next connection.
    if (watched[1].revents != 0 && (take_requests() || stopping)) {
      leave(connection.socket->get());
      return {};
    }

    // Reads whole lines; an oversized one is skipped and counted.
    if (watched[0].revents != 0) {
      const ssize_t got = ::recv(connection.socket->get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
      if (got == 0) return "it closed the connection";
      if (got < 0 && errno != EAGAIN && errno != EINTR) return std::strerror(errno);
      if (got > 0 && !connection.lines.push({bytes.data(), static_cast<std::size_t>(got)})) {
        note_malformed("an oversized line", protocol::usarsim::kMaxLineBytes);
      }
      while (const auto line = connection.lines.next()) read_line(*line, connection);
    }

    // The handshake may also end without a message, at its deadline.
    if (!connection.handed_over) finish_handshake(connection);
    if (connection.handshake.result() == WorldHandshake::Result::failed) return connection.handshake.failure();
  }
}

void WorldLink::read_line(std::string_view line, Connection& connection) {
  const protocol::usarsim::ParseError error = protocol::usarsim::parse_message(line, message_);
  if (error != protocol::usarsim::ParseError::none) {
    note_malformed(protocol::usarsim::describe(error), line.size());
    return;
  }
  note_warning();
  const bool is_frame = connection.transform.take(message_);
  if (!connection.handed_over) {
    connection.handshake.on_message(message_, is_frame, Clock::now(), connection.out);
    finish_handshake(connection);
  } else if (is_frame) {
    put(connection.transform.frame());
  } else if (message_.is("PONG")) {
    const auto id = message_.find("Id");
    const auto number = id ? protocol::usarsim::parse_number(*id) : std::nullopt;
    if (number && std::abs(*number) < 1e12) put(WorldPong{static_cast<std::int64_t>(*number)});
  } else if (auto answer = read_session_answer(message_)) {
    put(std::move(*answer));
  }
}

// Sends the handshake's output; once the handshake is complete, hands the connection over.
void WorldLink::finish_handshake(Connection& connection) {
  connection.handshake.on_time(Clock::now(), connection.out);
  send_whole(connection.socket->get(), connection.out);
  connection.out.clear();
  const auto result = connection.handshake.result();
  if (result != WorldHandshake::Result::extended && result != WorldHandshake::Result::plain) return;

  connection.handed_over = was_up_ = true;
  const auto radius = connection.transform.wheel_radius_m();
  if (!radius) {
    spdlog::warn("the world server reported no wheel radius (GEO): using USARSim's default of {} m",
                 SensorTransform::kDefaultWheelRadius_m);
  }
  const bool extended = result == WorldHandshake::Result::extended;
  WorldReady ready = connection.handshake.ready();
  const WorldFrame& frame = connection.transform.frame();
  if (!extended) {
    ready.robot_time_s = frame.state.robot_time_s;
    if (frame.interval_s > 0) ready.period_s = frame.interval_s;
  }
  put(LinkUp{request_.number, connection.socket, radius.value_or(SensorTransform::kDefaultWheelRadius_m), extended,
             ready});
  put(frame);
}

// If the relay is held up, this holds up the world through TCP rather than losing its messages.
void WorldLink::put(const WorldEvent& event) {
  while (!events_.put(event) && !*stopping_) std::this_thread::sleep_for(100us);
}

bool WorldLink::take_requests() {
  waker_.clear();
  bool any = false;
  requests_.take_all([&](const LinkRequest& request) {
    request_ = request;
    any = true;
  });
  return any;
}

// RES {Type Robot} {Name n} {Status OK} {Warning words}
void WorldLink::note_warning() {
  if (!message_.is("RES")) return;
  const auto words = message_.find("Warning");
  if (!words) return;
  if (const auto held_back = log_warnings_.allow()) {
    spdlog::warn("the world server warns of robot {}: {} ({} more before)", message_.find("Name").value_or(""), *words,
                 *held_back);
  }
}

void WorldLink::note_malformed(std::string_view what, std::size_t bytes) {
  if (const auto held_back = log_malformed_.allow()) {
    spdlog::warn("the world server sent {} ({} bytes): ignored ({} more before)", what, bytes, *held_back);
  }
}

}  // namespace kenaf::relayd
