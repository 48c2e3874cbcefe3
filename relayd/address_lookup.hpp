// Resolves a world server's name within a time limit: the system's own look-up (getaddrinfo) can be neither limited nor
// interrupted, and takes many seconds if a name server does not answer.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "relayd/sockets.hpp"

namespace kenaf::relayd {

// The system's look-up, however long it takes. Returns at least one endpoint; throws std::runtime_error with a text for
// the user.
std::vector<Endpoint> look_up(const protocol::HostPort& server);

// Looks names up in separate threads, one at a time; a late look-up is continued by the next call. A thread still
// running at destruction goes on by itself, using only its own copies. Thread safety: one object, one thread.
class AddressLookup {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  explicit AddressLookup(std::function<std::vector<Endpoint>(const protocol::HostPort&)> ask = look_up)
      : ask_(std::move(ask)) {}

  // nullopt: `cancel_fd` became readable. Throws std::runtime_error on failure and at `deadline`. A numeric address
  // takes neither time nor a thread. Always for the same server.
  std::optional<std::vector<Endpoint>> find(const protocol::HostPort& server, TimePoint deadline, int cancel_fd);

 private:
  struct UnderWay;

  std::function<std::vector<Endpoint>(const protocol::HostPort&)> ask_;
  std::shared_ptr<UnderWay> under_way_;
};

}  // namespace kenaf::relayd
