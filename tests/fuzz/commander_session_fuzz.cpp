// Any sequence of datagrams from three addresses, frames, losses and pauses. Whatever happens:
//   - the world is opened only while nobody commands, and closed exactly once for each session that began;
//   - a command reaches the world only from the one commander, and each sequence once, in order;
//   - States go to that commander alone.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "relayd/commander_session.hpp"
#include "tests/support/robot_command.hpp"

using namespace kenaf;
using namespace kenaf::relayd;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

struct Bytes {
  const std::uint8_t* data;
  std::size_t size;
  std::uint8_t next() {
    if (size == 0) return 0;
    --size;
    return *data++;
  }
};

struct Port : SessionPort {
  void send(const Peer& to, const protocol::relay::Datagram& datagram) override {
    if (std::holds_alternative<protocol::relay::State>(datagram)) require(to.address == opener);
    if (std::holds_alternative<protocol::relay::Welcome>(datagram)) require(open && to.address == opener);
  }
  void open_world(const protocol::relay::Hello& hello) override {
    require(!open);
    open = true;
    session = hello.session;
    opener = sender;
    sequence = 0;
  }
  void close_world() override {
    require(open);
    open = false;
  }
  void drive(const protocol::relay::Command& command, std::optional<std::int64_t> frame) override {
    require(open && sender == opener && command.session == session && command.sequence > sequence);
    require(!frame || *frame <= newest_frame);
    sequence = command.sequence;
  }
  void stop_robot() override { require(open); }
  bool ping_world(std::uint32_t id) override {
    require(open && sender == opener);
    return id % 2 == 0;
  }

  Address sender, opener;
  bool open = false;
  std::uint64_t session = 0;
  std::uint32_t sequence = 0;
  std::int64_t newest_frame = 0;
};

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  spdlog::set_level(spdlog::level::off);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes{data, size};
  Port port;
  CommanderSession session(port);
  CommanderSession::TimePoint now{std::chrono::hours(1)};
  while (bytes.size > 0) {
    const std::uint8_t what = bytes.next();
    port.sender.port = static_cast<std::uint16_t>(1 + what / 16 % 3);
    const std::uint64_t id = 1 + bytes.next() % 4;
    const auto datagram = [&](const protocol::relay::Datagram& content) {
      session.on_datagram(content, {port.sender}, now);
    };
    switch (what % 10) {
      case 0:
        datagram(
            protocol::relay::Hello{id, 0.01 * bytes.next(), 0.1 * bytes.next(), (what & 16) != 0, (what & 32) != 0});
        break;
      case 1:
        datagram(protocol::relay::Command{id, bytes.next(), bytes.next(),
                                          support::command_of({0.1 * bytes.next(), 0}, 1, {1.0 * bytes.next()})});
        break;
      case 2:
        datagram(protocol::relay::Bye{id});
        break;
      case 3:
        datagram(protocol::relay::Ping{id, bytes.next()});
        break;
      case 4:
        session.on_world_ready({0, 0.01, true}, now);
        break;
      case 5: {
        WorldFrame frame{{}, false, bytes.next(), (what & 16) != 0, 0.01};
        frame.state.robot_time_s = 0.1 * bytes.next();
        port.newest_frame = std::max(port.newest_frame, frame.number);
        session.on_frame(frame, now);
        break;
      }
      case 6:
        // A world that is lost has no session to close any more.
        if (bytes.next() % 4 == 0) session.on_world_lost("gone", now);
        if (session.session() == 0) port.open = false;
        break;
      case 7:
        session.on_pong(bytes.next(), now);
        break;
      default:
        now += std::chrono::milliseconds(10 * bytes.next());
        session.on_time(now, (what & 16) != 0);
        break;
    }
    require(port.open == (session.session() != 0));
    if (port.open) require(session.session() == port.session && session.commander() == port.opener);
  }
  return 0;
}
