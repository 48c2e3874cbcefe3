// Interface between the shared behaviour and a robot: one transport in libkenaf_sim (UDP to the relay), one in
// libkenaf_real (SocketCAN). SI units and the frames of robot/state.hpp.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "kenaf/hrt.h"
#include "robot/command.hpp"
#include "robot/state.hpp"

namespace kenaf::hrt {

struct Connection {
  double period_s;  // in force
  bool lockstep;    // in force
};

// Thread safety: open, wait_state, send, keep_alive and close are for one thread at a time; interrupt and the link
// health may be called from any thread while the transport is open.
class Transport {
 public:
  virtual ~Transport() = default;

  // Throws Error whose text says what to start or to connect.
  virtual Connection open(const hrt_config& config) = 0;

  // Called once after open(), by the same thread, as soon as the thread of the cycles has been made: before that one
  // is waited for, and before it calls begin_cycles. Throws Error.
  virtual void prepare_cycles([[maybe_unused]] std::thread::native_handle_type thread) {}

  // Called once by the thread that from then on calls wait_state and send for all cycles. Throws Error.
  virtual void begin_cycles() {}

  // Waits for the next cycle's state, whose frame is greater than all before; nullopt after interrupt(). Throws
  // Error(HRT_E_LINK) once the link is known to be lost, Error(HRT_E_DEVICE) if a device failed.
  virtual std::optional<robot::State> wait_state() = 0;

  // Answers the state that wait_state returned last. Delivered even if packets get lost. Flippers are commanded an
  // angle, or keep: those that the program has not commanded yet.
  virtual void send(const robot::Command& command) = 0;

  // The answer is delayed on purpose: tells this to a peer that would take the silence for an absent commander. Cheap
  // enough to be called every few milliseconds.
  virtual void keep_alive() {}

  // Makes wait_state return, now or at its next call; a state that has already arrived may be returned first.
  virtual void interrupt() = 0;

  // Stops the robot and releases it, even if it throws. Throws Error if the robot did not confirm that it stopped.
  virtual void close() = 0;

  // Describes what the robot runs without; "" if nothing is missing. As of the newest state; for the thread that calls
  // wait_state, and valid until its next call. Called in each cycle: does not allocate.
  virtual const std::string& warning() const {
    static const std::string nothing;
    return nothing;
  }

  // Describes what open() has found and set up, in lines without a last line end; "" if there is nothing to say.
  virtual std::string setup() const { return {}; }

  virtual double round_trip_s() const = 0;  // newest, wall clock; 0: not yet known
  virtual bool is_paused() const = 0;       // robot time has been stopped by somebody
};

// The library's own transport and name: each of the two libraries defines these.
std::unique_ptr<Transport> make_transport();
extern const char* const kLibraryName;  // "sim" or "real"

}  // namespace kenaf::hrt
