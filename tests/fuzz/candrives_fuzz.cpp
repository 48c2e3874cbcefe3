// Any frames at any times, and faults, into the simulated slaves: nothing dies, nothing turns whose drive is not
// powered, and what comes back is bounded.
//
// An input is a list of items, each with a first byte: below 0xc0 a frame after that many eighths of a millisecond (two
// bytes identifier, one byte length, data), else a wait of up to 128 ms, or a fault.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "can/candrives/ideal_plant.hpp"
#include "can/candrives/robot_slaves.hpp"
#include "tests/fuzz/can_input.hpp"

namespace {

using namespace kenaf;
using namespace kenaf::candrives;

void check(bool fine) {
  if (!fine) __builtin_trap();
}

const canbus::RobotBus& bus_of_kenaf() {
  static const canbus::RobotBus bus = canbus::load_robot_bus("kenaf");
  return bus;
}

// Holds a plant's every step against the drives' states.
class WatchedPlant final : public Plant {
 public:
  void advance(canopen::Time step, const PlantCommand& command) override {
    const PlantState before = plant_.state();
    plant_.advance(step, command);
    for (std::size_t i = 0; i < was_powered_.size(); ++i) {
      const canbus::DriveOnBus& drive = bus_of_kenaf().drives[i];
      const double moved = drive.is_flipper() ? state().flipper_rad[*drive.flipper] - before.flipper_rad[*drive.flipper]
                                              : state().track_m[drive.side] - before.track_m[drive.side];
      check(std::isfinite(moved));
      // the step in which a ramp ends is the last that moves; where a motor stands may be rounded, in counts and back
      const bool powered = slaves->drive(i).is_powered();
      if (!powered && !was_powered_[i]) check(std::abs(moved) < 1e-9);
      was_powered_[i] = powered;
    }
  }
  const PlantState& state() const override { return plant_.state(); }
  const RobotSlaves* slaves = nullptr;

 private:
  IdealPlant plant_;
  std::vector<bool> was_powered_ = std::vector<bool>(bus_of_kenaf().drives.size());
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 2048) return 0;
  WatchedPlant plant;
  RobotSlaves slaves(bus_of_kenaf(), plant, canopen::Time::zero());
  plant.slaves = &slaves;
  canopen::Time now{};
  fuzz::CanInput bytes{{data, size}};
  while (!bytes.empty()) {
    const std::uint8_t first = bytes.byte();
    Frames out;
    const canopen::Time before = now;
    if (first < 0xc0) {
      now += first * std::chrono::microseconds(125);
      canopen::Frame frame{.id = static_cast<std::uint16_t>((bytes.byte() | bytes.byte() << 8) & 0x7ff),
                           .length = static_cast<std::uint8_t>(bytes.byte() % 9)};
      for (std::size_t i = 0; i < frame.length; ++i) frame.data[i] = bytes.byte();
      slaves.on_frame(frame, now, out);
    } else if (first < 0xe0) {
      now += (first - 0xbf) * std::chrono::milliseconds(4);
      slaves.on_time(now, out);
    } else {
      const auto kind = static_cast<FaultKind>(first % (static_cast<int>(FaultKind::healed) + 1));
      slaves.inject({kind, static_cast<canopen::NodeId>(bytes.byte() & 0x0f), 0x2310}, now, out);
    }
    // In 1 ms a node sends its four PDOs, a heartbeat, and a few errors that come and go; a frame brings as much again.
    const auto passed_ms = static_cast<std::size_t>((now - before) / std::chrono::milliseconds(1));
    check(out.size() <= slaves.node_count() * 12 * (passed_ms + 2));
    check(slaves.deadline() > now - std::chrono::milliseconds(1));
    for (const canopen::Frame& frame : out) check(frame.id <= 0x7ff && frame.length <= 8);
  }
  return 0;
}
