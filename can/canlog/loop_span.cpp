#include "can/canlog/loop_span.hpp"

#include <optional>
#include <vector>

#include "can/canlog/bus_state.hpp"
#include "can/canlog/drive_frames.hpp"

namespace kenaf::canlog {

using canopen::DriveMode;
using canopen::PowerState;

namespace {

struct Followed {
  DriveMode mode;
  PowerState state = PowerState::undefined;
  std::optional<DriveCommand> last{};
};

// True if `command` asks the drive to move.
bool is_motion(const DriveCommand& command, const Followed& drive) {
  if (order_of(command.controlword) != DriveOrder::enable || drive.state != PowerState::operation_enabled) return false;
  const auto set_point = [](std::uint16_t word) { return (word & canopen::kControlNewSetPoint) != 0; };
  switch (drive.mode) {
    case DriveMode::profile_velocity:
    case DriveMode::cyclic_velocity:
      return command.target != 0;
    case DriveMode::profile_position:
      return set_point(command.controlword) && !(drive.last && set_point(drive.last->controlword));
    case DriveMode::cyclic_position:
      return drive.last && order_of(drive.last->controlword) == DriveOrder::enable &&
             command.target != drive.last->target;
    case DriveMode::homing:
      break;
  }
  return false;
}

}  // namespace

std::vector<LoopSpan> loop_spans(const Log& log, const Network& network) {
  // SDO writes may change a drive's mode, and what its PDOs contain.
  BusState bus(network);
  std::vector<Followed> drives;
  for (const canbus::DriveOnBus& drive : network.bus().drives) drives.push_back({.mode = drive.mode});

  // A span reaches from the first command that moves a drive to the newest such command.
  std::vector<LoopSpan> spans;
  bool within = false;
  for (std::size_t i = 0; i < log.frames.size(); ++i) {
    const LogFrame& logged = log.frames[i];
    if (logged.kind != canopen::FrameKind::data) continue;

    // Tracks the drives' modes and states, on which the meaning of a command depends.
    if (const auto written = bus.on_frame(logged)) {
      const auto drive = network.drive_of(written->node);
      if (drive && written->object == canopen::object::mode.object)
        drives[*drive].mode = static_cast<DriveMode>(written->number());
    }
    const PdoInForce* pdo = bus.setup().pdo(logged.frame.id);
    if (const auto status = drive_status_from(logged.frame, pdo))
      drives[status->drive].state = canopen::power_state_of(status->statusword);

    // Any NMT order but start ends the control loop, and with it the span.
    if (const auto order = canopen::nmt_order_from(logged.frame); order && order->command != canopen::NmtCommand::start)
      within = false;

    // The rest concerns commands to drives.
    const auto command = drive_command_from(logged.frame, pdo);
    if (!command) continue;
    Followed& drive = drives[command->drive];
    if (is_motion(*command, drive)) {
      if (!within) spans.push_back({i, i});
      within = true;
      spans.back().last = i;
    }
    drive.last = command;
  }
  return spans;
}

}  // namespace kenaf::canlog
