// What lies between the shared behaviour and a robot: one transport in libkenaf_sim (UDP to the relay), one in
// libkenaf_real (SocketCAN). SI units and the frames of robot/state.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "kenaf/hrt.h"
#include "robot/state.hpp"

namespace kenaf::hrt {

// What the robot shall do from the next cycle on. Complete and absolute.
struct DriveCommand {
  std::array<double, robot::kTrackCount> track_speed_mps{};
  std::uint8_t flipper_mask = 0;  // bit i: flipper_rad[i] was ever commanded
  std::array<double, robot::kFlipperCount> flipper_rad{};
};

struct Connection {
  double period_s;  // in force
  bool lockstep;    // in force
};

// Thread safety: open, wait_state, send, keep_alive and close belong to one thread at a time; interrupt and the link
// health may be called from any thread while it is open.
class Transport {
 public:
  virtual ~Transport() = default;

  // Throws Error in words that say what to start or to connect.
  virtual Connection open(const hrt_config& config) = 0;

  // Waits for the next cycle's state, whose frame is greater than all before; nullopt after interrupt(). Throws
  // Error(HRT_E_LINK) once the link is known to be lost, Error(HRT_E_DEVICE) where a device failed.
  virtual std::optional<robot::State> wait_state() = 0;

  // Answers the state that wait_state returned last. Delivers it even where packets get lost.
  virtual void send(const DriveCommand& command) = 0;

  // The answer is still being waited for: whoever would take the silence for an absent commander is told otherwise.
  // Cheap enough to be called every few milliseconds.
  virtual void keep_alive() {}

  // Makes wait_state return, now or at its next call; a state that is there already may be returned first.
  virtual void interrupt() = 0;

  // Stops the robot and gives it back, also where it throws: Error where the robot did not show that it stopped.
  virtual void close() = 0;

  // What the robot goes on without, in words; "" where nothing is missing. As of the newest state, for the thread that
  // waits for it.
  virtual std::string warning() const { return {}; }

  virtual double round_trip_s() const = 0;  // newest, wall clock; 0: not known yet
  virtual bool is_paused() const = 0;       // somebody has stopped robot time
};

// The library's own transport and name: each of the two libraries defines these.
std::unique_ptr<Transport> make_transport();
extern const char* const kLibraryName;  // "sim" or "real"

}  // namespace kenaf::hrt
