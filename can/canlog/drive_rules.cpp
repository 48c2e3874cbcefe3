#include "can/canlog/drive_rules.hpp"

#include <cmath>

#include "can/canlog/power_transitions.hpp"

namespace kenaf::canlog {

using canopen::DriveMode;
using canopen::PowerState;

DriveRules::DriveRules(const Network& network, const CheckOptions& options, Findings& findings)
    : network_(network), options_(options), findings_(findings) {
  for (const canbus::DriveOnBus& drive : network.bus().drives) drives_.push_back({.mode = drive.mode});
}

void DriveRules::on_frame(const LogFrame& logged, const PdoInForce* pdo) {
  if (canopen::is_sync(logged.frame)) ++syncs_;
  if (const auto status = drive_status_from(logged.frame, pdo)) on_status(logged, *status);
  if (const auto command = drive_command_from(logged.frame, pdo)) on_command(logged, *command);
}

void DriveRules::on_write(const WrittenObject& written) {
  const auto index = network_.drive_of(written.node);
  if (!index) return;
  Drive& drive = drives_[*index];
  if (written.object == canopen::object::mode.object) drive.mode = static_cast<DriveMode>(written.number());
  if (written.object == canopen::object::controlword.object)
    drive.orders.insert(order_of(static_cast<std::uint16_t>(written.number())));
}

void DriveRules::on_restart(canopen::NodeId node) {
  const auto index = network_.drive_of(node);
  if (index) drives_[*index] = {.mode = drives_[*index].mode, .followed = true};
}

template <class Holds>
bool DriveRules::could_be(const LogFrame& logged, const Drive& drive, Holds holds) const {
  if (!drive.shown || holds(*drive.shown)) return true;
  return drive.before && logged.at - drive.shown->at <= options_.crossing && holds(*drive.before);
}

// ---- commands ----

void DriveRules::on_command(const LogFrame& logged, const DriveCommand& command) {
  Drive& drive = drives_[command.drive];
  check_order(logged, command, drive);
  check_fault_reset(logged, command, drive);
  check_target(logged, command, drive);
  check_set_point(logged, command, drive);
  drive.command = command;
  drive.orders.insert(order_of(command.controlword));
  if (order_of(command.controlword) == DriveOrder::quick_stop) drive.ended = true;
  drive.followed = true;
}

void DriveRules::check_order(const LogFrame& logged, const DriveCommand& command, const Drive& drive) {
  const DriveOrder order = order_of(command.controlword);
  if (could_be(logged, drive, [&](const Shown& shown) { return has_transition(shown.state(), order); })) return;
  findings_.add(logged, rule::controlword, "{} is commanded \"{}\" in the state \"{}\", which has no such transition",
                name_of(command.drive), describe(order), describe(drive.shown->state()));
}

void DriveRules::check_fault_reset(const LogFrame& logged, const DriveCommand& command, const Drive& drive) {
  if (order_of(command.controlword) != DriveOrder::fault_reset) return;
  const std::string_view name = name_of(command.drive);
  // a device file may ask for more than one frame
  const bool once = network_.bus().drives[command.drive].device.fault_reset_cycles == 1;
  if (once && drive.command && order_of(drive.command->controlword) == DriveOrder::fault_reset)
    findings_.add(logged, rule::fault_reset, "bit 7 of {} stays 1: only its rising edge resets", name);
  if (could_be(logged, drive, [](const Shown& shown) { return shown.state() == PowerState::fault; })) return;
  findings_.add(logged, rule::fault_reset, "{} gets a fault reset in the state \"{}\"", name,
                describe(drive.shown->state()));
}

void DriveRules::check_target(const LogFrame& logged, const DriveCommand& command, const Drive& drive) {
  if (!drive.shown) return;
  const std::string_view name = name_of(command.drive);
  const bool enabled =
      could_be(logged, drive, [](const Shown& shown) { return shown.state() == PowerState::operation_enabled; });
  const bool enables = order_of(command.controlword) == DriveOrder::enable;
  if (!network_.bus().drives[command.drive].is_flipper()) {
    if (command.target == 0 || (enabled && enables && !drive.ended)) return;
    findings_.add(logged, rule::target, "{} gets a speed {}", name,
                  drive.ended ? "after its quick stop"
                  : !enables  ? fmt::format("with \"{}\"", describe(order_of(command.controlword)))
                              : fmt::format("in the state \"{}\"", describe(drive.shown->state())));
    return;
  }
  if (enabled) return;
  const double tolerance =
      std::abs(network_.bus().drives[command.drive].units.counts_per_unit) * options_.hold_tolerance_rad;
  const auto holds = [&](const Shown& shown) {
    return std::abs(static_cast<double>(command.target) - shown.status.position) <= tolerance;
  };
  if (holds(*drive.shown) || (drive.before && holds(*drive.before))) return;
  findings_.add(logged, rule::target, "{} is sent to {} in the state \"{}\", where it is at {}", name, command.target,
                describe(drive.shown->state()), drive.shown->status.position);
}

// Bit 4 requests, bit 12 acknowledges: bit 4 may rise only while bit 12 is 0, and fall once it is 1.
void DriveRules::check_set_point(const LogFrame& logged, const DriveCommand& command, const Drive& drive) {
  if (drive.mode != DriveMode::profile_position || !drive.shown || !drive.command) return;
  const auto is_enabled = [](std::uint16_t word) { return order_of(word) == DriveOrder::enable; };
  if (!is_enabled(command.controlword) || !is_enabled(drive.command->controlword)) return;
  if (drive.shown->state() != PowerState::operation_enabled) return;
  const auto asks = [](std::uint16_t word) { return (word & canopen::kControlNewSetPoint) != 0; };
  const bool asked = asks(drive.command->controlword);
  if (asks(command.controlword) == asked) return;
  const auto fits = [&](const Shown& shown) {
    const bool acknowledged = (shown.status.statusword & canopen::kStatusSetPointAcknowledged) != 0;
    return acknowledged == asked;
  };
  if (could_be(logged, drive, fits)) return;
  findings_.add(logged, rule::set_point, "{}: new set-point is {}", name_of(command.drive),
                asked ? "taken back before the drive has acknowledged it"
                      : "raised while the drive still acknowledges the one before");
}

// ---- states shown by the drive ----

void DriveRules::on_status(const LogFrame& logged, const DriveStatus& status) {
  Drive& drive = drives_[status.drive];
  check_transition(logged, status, drive);
  const PowerState state = canopen::power_state_of(status.statusword);
  const bool changed = !drive.shown || drive.shown->state() != state;
  if (changed) {
    drive.orders.clear();
    if (drive.command) drive.orders.insert(order_of(drive.command->controlword));
    if (drive.shown && state != PowerState::quick_stop_active) drive.ended = false;
  }
  drive.before = drive.shown;
  drive.shown = Shown{status, logged.at, syncs_};
}

void DriveRules::check_transition(const LogFrame& logged, const DriveStatus& status, const Drive& drive) {
  const PowerState to = canopen::power_state_of(status.statusword);
  const std::string_view name = name_of(status.drive);
  if (to == PowerState::undefined) {
    findings_.add(logged, rule::statusword, "{} shows statusword {:#06x}, which is not a state", name,
                  status.statusword);
    return;
  }
  // if statuswords are missing, intermediate states may be too
  if (!drive.shown || drive.shown->state() == to || syncs_ - drive.shown->sync > 1) return;
  const PowerState from = drive.shown->state();
  if (from == PowerState::undefined) return;
  const auto transition = transition_between(from, to);
  if (!transition) {
    findings_.add(logged, rule::statusword, "{} goes from \"{}\" to \"{}\", for which there is no transition", name,
                  describe(from), describe(to));
  } else if (drive.followed && !transition->by_itself() && !transition->ordered_by(drive.orders)) {
    findings_.add(logged, rule::statusword, "{} goes from \"{}\" to \"{}\" without an order to", name, describe(from),
                  describe(to));
  }
}

}  // namespace kenaf::canlog
