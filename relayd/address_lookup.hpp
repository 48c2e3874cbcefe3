// From a world server's name to its addresses, without waiting longer than one wants to: the system's own look-up
// (getaddrinfo) can be neither limited nor interrupted, and takes many seconds where a name server does not answer.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "relayd/sockets.hpp"

namespace kenaf::relayd {

// The system's, as long as it takes. At least one, or std::runtime_error in words.
std::vector<Endpoint> look_up(const HostPort& server);

// Looks names up in threads of their own, one at a time; one that is late is waited for by the next call. A thread that
// is still at it when this ends goes on by itself, with nothing but its own copies. Thread safety: one object, one
// thread.
class AddressLookup {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  explicit AddressLookup(std::function<std::vector<Endpoint>(const HostPort&)> ask = look_up) : ask_(std::move(ask)) {}

  // nullopt: `cancel_fd` became readable. Throws std::runtime_error in words, also at `deadline`. An address in digits
  // takes neither time nor a thread. Always for the same server.
  std::optional<std::vector<Endpoint>> find(const HostPort& server, TimePoint deadline, int cancel_fd);

 private:
  struct UnderWay;

  std::function<std::vector<Endpoint>(const HostPort&)> ask_;
  std::shared_ptr<UnderWay> under_way_;
};

}  // namespace kenaf::relayd
