// A relay in its own thread, for tests that talk to it over real sockets.
#pragma once

#include <spdlog/sinks/ringbuffer_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "relayd/relay.hpp"
#include "tests/support/patience.hpp"

namespace kenaf::test {

using support::eventually;

// What the relay logs, instead of printing it.
class LogCapture {
 public:
  LogCapture() : sink_(std::make_shared<spdlog::sinks::ringbuffer_sink_mt>(200)), before_(spdlog::default_logger()) {
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", sink_));
  }
  ~LogCapture() { spdlog::set_default_logger(before_); }
  int count(const std::string& part) const {
    const auto lines = sink_->last_formatted();
    return static_cast<int>(std::count_if(
        lines.begin(), lines.end(), [&](const std::string& line) { return line.find(part) != std::string::npos; }));
  }

 private:
  std::shared_ptr<spdlog::sinks::ringbuffer_sink_mt> sink_;
  std::shared_ptr<spdlog::logger> before_;
};

class RunningRelay {
 public:
  explicit RunningRelay(std::uint16_t world_port, const std::string& address = "127.0.0.1:0")
      : relay_(options(world_port, address)), thread_([this] { relay_.run(); }) {}
  ~RunningRelay() { stop(); }
  std::uint16_t port() const { return relay_.address().port; }
  void stop() {
    if (!thread_.joinable()) return;
    relay_.stop();
    thread_.join();
  }

 private:
  static relayd::RelayOptions options(std::uint16_t world_port, const std::string& address) {
    relayd::RelayOptions out;
    out.world_server = {"127.0.0.1", world_port};
    out.listen = relayd::parse_address(address);
    return out;
  }
  LogCapture log_;  // before the relay, so that it lives longer

 public:
  const LogCapture& log() const { return log_; }

 private:
  relayd::Relay relay_;
  std::thread thread_;
};

inline bool is_welcome(const protocol::relay::Datagram& datagram) {
  return std::holds_alternative<protocol::relay::Welcome>(datagram);
}
inline protocol::relay::Refused refusal(const protocol::relay::Datagram& datagram) {
  REQUIRE(std::holds_alternative<protocol::relay::Refused>(datagram));
  return std::get<protocol::relay::Refused>(datagram);
}

}  // namespace kenaf::test
