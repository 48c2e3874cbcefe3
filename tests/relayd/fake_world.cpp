#include "tests/relayd/fake_world.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "tests/relayd/allocations.hpp"
#include "tests/support/loopback.hpp"

namespace kenaf::test {

namespace {

constexpr double kWheelRadius_m = 0.05;
constexpr double kTick_rad = 0.001;

double number(const protocol::usarsim::MessageView& message, std::string_view key, double otherwise) {
  const auto text = message.find(key);
  return text ? protocol::usarsim::parse_number(*text).value_or(otherwise) : otherwise;
}

}  // namespace

FakeWorld::FakeWorld(const FakeWorldOptions& options) : options_(options) {
  listener_ = relayd::Descriptor(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const int on = 1;
  ::setsockopt(listener_.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address = loopback(options.port);
  socklen_t size = sizeof address;
  if (::bind(listener_.get(), reinterpret_cast<sockaddr*>(&address), size) != 0 || ::listen(listener_.get(), 4) != 0) {
    throw std::runtime_error("fake world cannot listen");
  }
  ::getsockname(listener_.get(), reinterpret_cast<sockaddr*>(&address), &size);
  port_ = ntohs(address.sin_port);
  thread_ = std::thread(&FakeWorld::run, this);
}

FakeWorld::~FakeWorld() {
  stopping_ = true;
  thread_.join();
}

std::vector<std::string> FakeWorld::lines() const {
  const std::lock_guard lock(mutex_);
  return lines_;
}

int FakeWorld::count(const std::string& beginning) const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(
      std::count_if(lines_.begin(), lines_.end(), [&](const auto& line) { return line.starts_with(beginning); }));
}

std::string FakeWorld::last(const std::string& beginning) const {
  const std::lock_guard lock(mutex_);
  const auto found =
      std::find_if(lines_.rbegin(), lines_.rend(), [&](const auto& line) { return line.starts_with(beginning); });
  return found == lines_.rend() ? "" : *found;
}

void FakeWorld::run() {
  leave_this_thread_out();
  while (!stopping_) {
    pollfd listening{listener_.get(), POLLIN, 0};
    if (::poll(&listening, 1, 5) <= 0) continue;
    const relayd::Descriptor fd(::accept(listener_.get(), nullptr, nullptr));
    const int on = 1;
    ::setsockopt(fd.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    ++connections_;
    has_robot_ = lockstep_ = numbered_ = owes_frame_ = false;
    period_s_ = 0.2;
    time_s_ = left_radps_ = right_radps_ = left_rad_ = right_rad_ = 0;
    frame_ = late_ = 0;
    joints_ = {{"FRFlipper", 0}, {"FLFlipper", 0}, {"RRFlipper", 0}, {"RLFlipper", 0}};
    x_m_ = speed_mps_ = 0;
    serve(fd.get());
  }
}

// Without lock step a frame goes out every 2 ms of wall-clock time, whatever its robot time. Lock step waits for ever,
// so that no test depends on how fast the machine is.
void FakeWorld::serve(int fd) {
  protocol::usarsim::LineSplitter splitter;
  std::array<char, 4096> bytes;
  send_text(fd, "NFO {Gametype BotDeathMatch} {Level Fake} {TimeLimit 20}\r\n");
  auto sent = std::chrono::steady_clock::now();
  while (!stopping_) {
    pollfd reading{fd, POLLIN, 0};
    if (::poll(&reading, 1, 1) > 0) {
      const ssize_t got = ::recv(fd, bytes.data(), bytes.size(), 0);
      if (got <= 0) return;
      splitter.push({bytes.data(), static_cast<std::size_t>(got)});
      while (const auto line = splitter.next()) {
        if (!handle(std::string(*line), fd)) return;
      }
      if (has_robot_ && owes_frame_) {
        owes_frame_ = false;
        ++frame_;
        send_frame(fd);
      }
    }
    if (!has_robot_ || lockstep_ || std::chrono::steady_clock::now() - sent < std::chrono::milliseconds(2)) continue;
    sent = std::chrono::steady_clock::now();
    step();
    send_frame(fd);
  }
}

// False: it closes the connection.
bool FakeWorld::handle(const std::string& line, int fd) {
  {
    const std::lock_guard lock(mutex_);
    lines_.push_back(line);
  }
  protocol::usarsim::MessageView message;
  protocol::usarsim::parse_message(line, message);
  const auto type = message.find("Type").value_or("");
  if (message.is("INIT")) {
    has_robot_ = options_.accepts_robot;
    owes_frame_ = true;
  } else if (message.is("GETGEO") && has_robot_) {
    send_text(fd, "GEO {Type GroundVehicle} {Name Kenaf} {WheelRadius 0.05} {WheelSeparation 0.4}\r\n");
  } else if (message.is("GETCONF") && type == "Encoder" && has_robot_) {
    send_text(fd, "CONF {Type Encoder} {Name Encoder} {Resolution 0.001}\r\n");
  } else if (message.is("CONTROL") && closes_at_control_.exchange(false)) {
    return false;
  } else if (message.is("CONTROL") && options_.extended) {
    period_s_ = number(message, "Period", period_s_);
    lockstep_ = message.find("Lockstep") == "True";
    numbered_ = true;
    frame_ = 0;
    send_text(fd, fmt::format("RES {{Time {}}} {{Type Control}} {{Name Session}} {{Status OK}} {{Period {}}} "
                              "{{Lockstep {}}}\r\n",
                              time_s_, period_s_, lockstep_ ? "True" : "False"));
    owes_frame_ = true;
  } else if (message.is("PING") && options_.extended) {
    send_text(fd, fmt::format("PONG {{Id {}}} {{Time {}}}\r\n", message.find("Id").value_or("0"), time_s_));
  } else if (message.is("MULTIDRIVE")) {
    for (auto& [name, angle_rad] : joints_) angle_rad = number(message, name, angle_rad);
  } else if (message.is("DRIVE")) {
    left_radps_ = number(message, "Left", left_radps_);
    right_radps_ = number(message, "Right", right_radps_);
    speed_mps_ = (left_radps_ + right_radps_) / 2 * kWheelRadius_m;
    const double answered = number(message, "Frame", 0);
    if (answered > 0 && answered < static_cast<double>(frame_)) ++late_;
    if (lockstep_ && answered == static_cast<double>(frame_)) {
      step();
      send_frame(fd);
    }
  }
  return true;
}

void FakeWorld::step() {
  left_rad_ += left_radps_ * period_s_;
  right_rad_ += right_radps_ * period_s_;
  x_m_ = (left_rad_ + right_rad_) / 2 * kWheelRadius_m;
  time_s_ += period_s_;
  ++frame_;
}

void FakeWorld::send_frame(int fd) {
  std::string text = options_.garbage;
  text += fmt::format("SEN {{Type INS}} {{Name INS}} {{Location {},0,0}} {{Orientation 0.1,0.2,0.3}}\r\n", x_m_.load());
  text += fmt::format("SEN {{Type Encoder}} {{Name ECLeft Tick {}}} {{Name ECRight Tick {}}}\r\n",
                      std::llround(left_rad_ / kTick_rad), std::llround(right_rad_ / kTick_rad));
  text += fmt::format(
      "SEN {{Time {:.12f}}} {{Type GroundTruth}} {{Name GroundTruth}} {{Location {:.12f},0,-0.1}} "
      "{{Orientation 0,0,0}}\r\n",
      time_s_, x_m_.load());
  text += fmt::format("STA {{Type GroundVehicle}} {{Time {:.12f}}}", time_s_);
  for (const char* name : {"FRFlipper", "FLFlipper", "RRFlipper", "RLFlipper"}) {
    text += fmt::format(" {{{} {:.12f}}}", name, joints_[name]);
  }
  if (numbered_) text += fmt::format(" {{Frame {}}} {{Late {}}} {{Steps 0}} {{Paused False}}", frame_, late_);
  send_text(fd, text + "\r\n");
}

void FakeWorld::send_text(int fd, const std::string& text) {
  if (mute_) return;
  const std::size_t piece = options_.piece == 0 ? text.size() : options_.piece;
  for (std::size_t i = 0; i < text.size(); i += piece) {
    if (::send(fd, text.data() + i, std::min(piece, text.size() - i), MSG_NOSIGNAL) < 0) return;
  }
}

}  // namespace kenaf::test
