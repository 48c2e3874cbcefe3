// Nodes that send anything at any time: the master ends with an error that has words, or goes on; and no robot that is
// commanded to stand moves.
//
// The input's first byte says how many frames come undisturbed; then each byte what happens to the next frame of a
// node: it passes, is dropped, cut, lengthened, has another identifier or another byte.
#include <cstddef>
#include <cstdint>
#include <span>

#include "hrt/error.hpp"
#include "tests/fuzz/can_input.hpp"
#include "tests/libkenaf_real/robot_on_bus.hpp"

using namespace kenaf;

namespace {

// False: dropped.
bool alter(canopen::Frame& frame, fuzz::CanInput& bytes) {
  switch (bytes.byte() % 8) {
    case 0:
      return false;
    case 1:
      if (frame.length > 0) frame.data[--frame.length] = 0;
      return true;
    case 2:
      if (frame.length < canopen::kMaxFrameBytes) frame.data[frame.length++] = bytes.byte();
      return true;
    case 3:
      // of what nodes send: emergencies, TPDOs, SDO answers, heartbeats; the rest would be another master's
      frame.id = static_cast<std::uint16_t>((frame.id & 0x07f) | (bytes.byte() % 2 == 0 ? 0x180 : 0x580));
      return true;
    case 4:
      frame.data[bytes.byte() % canopen::kMaxFrameBytes] = bytes.byte();
      return true;
    default:
      return true;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::CanInput bytes{{data, size}};
  real::RobotOnBus robot;
  // set-up takes some 600 frames of the nodes: the loop is reached too
  std::size_t undisturbed = 8u * bytes.byte();
  robot.wire.alter = [&](canopen::Frame& frame, candrives::Sender sender) {
    if (sender == candrives::Sender::master || bytes.empty()) return true;
    if (undisturbed > 0) return --undisturbed, true;
    const bool kept = alter(frame, bytes);
    for (std::size_t i = frame.length; i < canopen::kMaxFrameBytes; ++i) frame.data[i] = 0;
    return kept;
  };
  try {
    robot.open();
    robot.run(20, {});
  } catch (const hrt::Error& error) {
    if (*error.what() == '\0') __builtin_trap();
  }
  robot.transport.close();
  if (!robot.stands() || robot.plant.state().track_m != std::array<double, 2>{} ||
      robot.plant.state().flipper_rad != std::array<double, 4>{})
    __builtin_trap();
  return 0;
}
