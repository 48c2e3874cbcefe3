// A bus as a master or a slave uses it: it sends frames and waits for frames. Two implementations: SocketCAN's
// (can/canbus/socket_bus.hpp) and one in the tests, whose slaves and time are in the same process.
//
// Thread safety: interrupt may be called from any thread; all else belongs to one.
#pragma once

#include <optional>
#include <stdexcept>

#include "can/canopen/frame.hpp"

namespace kenaf::canopen {

// The bus as a whole no longer works: interface down or gone, bus off. In words, with what to do.
class BusError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// It takes no frame now, and may take one later: so far nobody acknowledges any, or the controller is to be back on the
// bus soon.
class BusFull : public BusError {
 public:
  using BusError::BusError;
};

struct ReceivedFrame {
  Frame frame;
  Time at;  // when it was on the bus
};

class Bus {
 public:
  virtual ~Bus() = default;
  virtual Time now() const = 0;
  // Throws BusError; BusFull, having waited a little.
  virtual void send(const Frame& frame) = 0;
  // The next frame of another node, or a SYNC of start_sync; nullopt once `until` has come or interrupt() was called
  // since the last call. Throws BusError.
  virtual std::optional<ReceivedFrame> receive(Time until) = 0;
  // Sends a SYNC at once and then every `period`, by a clock that does not wait for this program; it ends with the
  // program. Throws BusError.
  virtual void start_sync(Time period) = 0;
  virtual void stop_sync() = 0;
  virtual void interrupt() = 0;
};

}  // namespace kenaf::canopen
