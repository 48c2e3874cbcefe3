// The relay: three threads and the messages between them.
//
//   commands (UDP) -> receiver --Arrivals--> sender --> world server (TCP), States (UDP)
//   sensors (TCP) --> world link --WorldEvents--> sender
//
// The receiver reads and checks datagrams as they arrive. The world link reads the sensor stream and converts it to
// States. The sender, woken by either or by its next deadline, decides and writes: all output goes through it, so no
// lock is needed. run() is the sender's thread.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "formats/protocol/log_limiter.hpp"
#include "formats/protocol/relay_datagram.hpp"
#include "relayd/commander_session.hpp"
#include "relayd/mailbox.hpp"
#include "relayd/sockets.hpp"
#include "relayd/world_link.hpp"

namespace kenaf::relayd {

struct RelayOptions {
  protocol::HostPort world_server{"127.0.0.1", 3000};
  Address listen = parse_address("127.0.0.1:45454");  // port 0: any free one
  RobotPlacement placement;
};

class Relay : private SessionPort {
 public:
  // Binds the socket. Throws std::runtime_error with a text for the user.
  explicit Relay(const RelayOptions& options);

  // The address it listens on.
  const Address& address() const { return address_; }

  // Relays until stop(); then tells the commander, stops the robot, and returns after all threads have ended.
  void run();
  // May be called from any thread or a signal handler.
  void stop();

 private:
  using TimePoint = std::chrono::steady_clock::time_point;

  struct Arrival {
    protocol::relay::Datagram datagram;
    Address from;
  };

  // The receiver's thread.
  void receive_commands();
  void take_datagram(std::size_t bytes, const Address& from);

  // The sender's thread.
  void take_mail();
  void take(const WorldFrame& frame);
  void take(const WorldPong& pong);
  void take(const SessionAnswer& answer);
  void take(const LinkUp& up);
  void take(const LinkDown& down);
  void watch_world(TimePoint now);
  void leave_world(std::string_view why, TimePoint now);
  void wait_for_mail();
  void flush();
  void request_link(const WorldSession& session);
  void shut_down();

  void send(const Address& to, const protocol::relay::Datagram& datagram) override;
  void open_world(const protocol::relay::Hello& hello) override;
  void close_world() override;
  void drive(const protocol::relay::Command& command, std::optional<std::int64_t> world_frame) override;
  void stop_robot() override;
  bool ping_world(std::uint32_t id) override;

  const RelayOptions options_;
  Address address_;
  Descriptor udp_;
  std::atomic<bool> stopping_{false};     // asked to stop
  std::atomic<bool> threads_end_{false};  // the other two may end: the robot has been stopped

  Waker sender_waker_;
  Mailbox<Arrival, 1024> arrivals_{sender_waker_};
  WorldEvents events_{sender_waker_};
  WorldLink link_;

  // The receiver's.
  Waker receiver_waker_;
  std::array<std::byte, protocol::relay::kMaxDatagramBytes + 1> received_;  // one more, to detect longer ones
  Arrival arrival_;
  protocol::LogLimiter log_malformed_, log_overflow_;

  // The sender's.
  CommanderSession session_{*this};
  std::optional<LinkUp> world_;
  std::uint64_t wanted_link_ = 0;
  int unanswered_sessions_ = 0;  // CONTROL {Type Session} sent; only the answer to the newest counts
  WorldReady newest_;            // time and interval of the newest frame, for a server that announces neither
  TimePoint world_heard_, world_pinged_;
  std::string out_;  // for the world server, not yet taken by its socket
};

}  // namespace kenaf::relayd
