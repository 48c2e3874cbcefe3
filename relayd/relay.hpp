// The relay: three threads, each of which brings something to decide.
//
//   commands (UDP) -> receiver ----Arrivals----+
//   sensors (TCP) --> world link --WorldEvents-+--> decision --> world server (TCP), States (UDP)
//   deadlines ------> timekeeper --------------+
//
// The receiver reads and checks datagrams as they arrive. The world link reads the sensor stream and converts it to
// States. Whoever brings something decides and writes at once, on its own thread, unless another thread is at it, which
// then decides that, too (one_at_a_time.hpp): so a message wakes no other thread on its way. run() is the timekeeper's
// thread.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "formats/protocol/log_limiter.hpp"
#include "formats/protocol/relay_datagram.hpp"
#include "relayd/commander_session.hpp"
#include "relayd/mailbox.hpp"
#include "relayd/one_at_a_time.hpp"
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
    Peer from;
  };

  // The receiver's thread.
  void receive_commands();
  void take_datagram(std::size_t bytes, const Peer& from);

  // Any thread, once it has brought something: decides, or leaves that to a thread that is at it.
  void attend() {
    decision_.ask([this] { decide(); });
  }

  // One thread at a time.
  void decide();
  void take_mail();
  void take(const WorldFrame& frame);
  void take(const WorldPong& pong);
  void take(const SessionAnswer& answer);
  void take(const LinkUp& up);
  void take(const LinkDown& down);
  void watch_world(TimePoint now);
  void leave_world(std::string_view why, TimePoint now);
  void set_alarm(TimePoint now);
  void flush();
  void request_link(const WorldSession& session);
  void shut_down();

  // The timekeeper's thread.
  void wait_for_alarm();

  void send(const Peer& to, const protocol::relay::Datagram& datagram) override;
  void open_world(const protocol::relay::Hello& hello) override;
  void close_world() override;
  void drive(const protocol::relay::Command& command, std::optional<std::int64_t> world_frame) override;
  void stop_robot() override;
  bool ping_world(std::uint32_t id) override;

  const RelayOptions options_;
  Address address_;
  Descriptor udp_;
  std::atomic<bool> stopping_{false};     // asked to stop
  std::atomic<bool> threads_end_{false};  // the robot has been stopped: nothing more is decided

  OneAtATime decision_;
  Mailbox<Arrival, 1024> arrivals_{[this] { attend(); }};
  WorldEvents events_{[this] { attend(); }};
  WorldLink link_;

  // When the timekeeper has to ask for a decision.
  struct Alarm {
    TimePoint at = TimePoint::max();
    std::shared_ptr<Descriptor> writable;  // or as soon as this socket takes more; may be null
  };
  Waker timekeeper_waker_;
  std::mutex alarm_mutex_;
  Alarm alarm_;        // the newest
  Alarm waiting_for_;  // the one that the timekeeper waits for, or did last

  // The receiver's.
  Waker receiver_waker_;
  std::array<std::byte, protocol::relay::kMaxDatagramBytes + 1> received_;  // one more, to detect longer ones
  Arrival arrival_;
  protocol::LogLimiter log_malformed_, log_overflow_;

  // The decision's.
  CommanderSession session_{*this};
  std::optional<LinkUp> world_;
  std::uint64_t wanted_link_ = 0;
  int unanswered_sessions_ = 0;  // CONTROL {Type Session} sent; only the answer to the newest counts
  WorldReady newest_;            // time and interval of the newest frame, for a server that announces neither
  TimePoint world_heard_, world_pinged_;
  std::string out_;  // for the world server, not yet taken by its socket
};

}  // namespace kenaf::relayd
