// The relay's second thread: keeps a connection to the world server and converts its messages to WorldEvents. After it
// has handed a connection over with LinkUp it only reads; the relay does all further writing.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>

#include "formats/protocol/log_limiter.hpp"
#include "formats/protocol/usarsim_message.hpp"
#include "relayd/address_lookup.hpp"
#include "relayd/mailbox.hpp"
#include "relayd/sensor_transform.hpp"
#include "relayd/sockets.hpp"
#include "relayd/world_handshake.hpp"

namespace kenaf::relayd {

// Requests a new connection with these settings; a connection of an earlier request is closed.
struct LinkRequest {
  std::uint64_t number = 0;
  WorldSession session;
};

struct LinkUp {
  std::uint64_t request = 0;           // the request it fulfils
  std::shared_ptr<Descriptor> socket;  // closed when its last owner releases it
  double wheel_radius_m = 0;
  bool extended = false;
  WorldReady ready;
};
struct LinkDown {
  std::uint64_t request = 0;
  std::string why;
};
struct WorldPong {
  std::int64_t id = 0;
};
using WorldEvent = std::variant<WorldFrame, WorldPong, SessionAnswer, LinkUp, LinkDown>;

using WorldEvents = Mailbox<WorldEvent, 256>;
using LinkRequests = Mailbox<LinkRequest, 16>;

class WorldLink {
 public:
  WorldLink(const protocol::HostPort& server, const RobotPlacement& placement, WorldEvents& events);

  // Connects, retrying as needed, until `stopping` is set and waker() woken.
  void run(const std::atomic<bool>& stopping);

  Waker& waker() { return waker_; }
  LinkRequests& requests() { return requests_; }  // filled by the relay

 private:
  struct Connection;

  std::string serve(const std::atomic<bool>& stopping);
  void read_line(std::string_view line, Connection& connection);
  void finish_handshake(Connection& connection);
  void put(const WorldEvent& event);
  bool take_requests();
  void note_malformed(std::string_view what, std::size_t bytes);
  void note_warning();

  const protocol::HostPort server_;
  const RobotPlacement placement_;
  WorldEvents& events_;
  Waker waker_;
  LinkRequests requests_{[this] { waker_.wake(); }};
  LinkRequest request_;
  AddressLookup lookup_;
  const std::atomic<bool>* stopping_ = nullptr;
  protocol::usarsim::MessageView message_;
  protocol::LogLimiter log_malformed_;
  protocol::LogLimiter log_warnings_;
  bool was_up_ = false;
};

}  // namespace kenaf::relayd
