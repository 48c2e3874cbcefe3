// A bus as seen by a master or a slave: sends frames and waits for frames. Two implementations: SocketCAN
// (can/canbus/socket_bus.hpp) and one in the tests, with slaves and time in the same process.
//
// Thread safety: interrupt may be called from any thread; everything else is for one thread.
#pragma once

#include <optional>
#include <stdexcept>

#include "can/canopen/frame.hpp"

namespace kenaf::canopen {

// The whole bus no longer works: interface down or gone, or bus off. The text says what to do.
class BusError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The bus accepts no frame now, but may later: nobody has acknowledged one yet, or the controller is about to return to
// the bus.
class BusFull : public BusError {
 public:
  using BusError::BusError;
};

struct ReceivedFrame {
  Frame frame;
  Time at;  // time of reception
};

class Bus {
 public:
  virtual ~Bus() = default;
  virtual Time now() const = 0;
  // How long the computer was suspended since the bus was opened: now() stands still meanwhile, but the nodes go on.
  virtual Time suspended() { return {}; }
  // Throws BusError; BusFull after a short wait.
  virtual void send(const Frame& frame) = 0;
  // Returns the next frame of another node, or a SYNC of start_sync; nullopt at `until`, or if interrupt() was called
  // since the last call. Throws BusError.
  virtual std::optional<ReceivedFrame> receive(Time until) = 0;
  // Sends a SYNC at once and then every `period`, by a clock independent of this program; it ends with the program.
  // Throws BusError.
  virtual void start_sync(Time period) = 0;
  virtual void stop_sync() = 0;
  virtual void interrupt() = 0;
};

}  // namespace kenaf::canopen
