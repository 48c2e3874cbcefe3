#include "libkenaf_real/power.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <vector>

#include "can/canbus/node_setup.hpp"
#include "hrt/error.hpp"
#include "libkenaf_real/advice.hpp"
#include "libkenaf_real/commissioning.hpp"
#include "libkenaf_real/drive_watches.hpp"

namespace kenaf::real {
namespace {

using canbus::ModeChange;
using canopen::DriveMode;
using canopen::PowerState;
using canopen::Time;
using hrt::Error;

constexpr Time kPowerUp = std::chrono::seconds(3);  // relays and capacitors
constexpr Time kModeChange = std::chrono::seconds(1);
// A drive may report "attained" of the previous homing for this long.
constexpr Time kHomingBegins = std::chrono::milliseconds(100);
// A drive's emergency message may come so much later than the statusword that shows the fault.
constexpr Time kEmergencyFollows = std::chrono::milliseconds(20);
// A stop that is ordered shows within the time that one takes whose commands stay away, and these cycles of answers.
constexpr double kShortestPowerDown_s = 0.3, kStopShows_s = 0.1;
// Leaving quick stop straight to operation (CiA 402, transition 16) keeps the torque of flippers that carry the robot,
// but not every drive supports it; after this many commands quick stop is left through "switch on disabled".
constexpr int kHoldThroughQuickStop = 20;
// A drive leaves quick stop for operation only by an "enable" that follows another controlword: repeated ones do not
// count (PowerStates in can/candrives/power_states.hpp). One that stopped by itself because its master died has
// "enable" as its last controlword. So it first gets "quick stop", which has no effect in that state (CiA 402-2, 10),
// and gets it again every few commands, since a frame may get lost.
constexpr int kEdgeEachCommands = 4;
constexpr double kHomeTolerance_rad = 0.05;  // between a drive's position after homing and the expected one

PowerState state_of(const BusCycle& cycle, std::size_t i) {
  return canopen::power_state_of(cycle.image().drive(i).statusword);
}

const canbus::Device& device_of(const BusCycle& cycle, std::size_t i) {
  return cycle.bus().drives[i].device;
}

std::int32_t target_here(const BusCycle& cycle, std::size_t i) {
  return is_position(cycle.bus().drives[i].mode) ? cycle.image().drive(i).position : 0;
}

// The target of a drive that is to stay: where it is, until it has been seen enabled, and from then on what it was told
// last. A flipper under load lies below its target; targets that follow what is measured would let it down, each cycle
// by as much.
std::int32_t hold_target(const BusCycle& cycle, std::size_t i) {
  const DriveOrder& last = cycle.sent()[i];
  const bool was_enabled = (last.controlword & canopen::kControlEnable) == canopen::kControlEnable;
  return was_enabled && state_of(cycle, i) == PowerState::operation_enabled ? last.target : target_here(cycle, i);
}

std::string not_enabled(const BusCycle& cycle, std::size_t i) {
  const DriveInput& drive = cycle.image().drive(i);
  return fmt::format("{} could not be enabled: it is in the state \"{}\" (statusword {:#06x}){}{}{}",
                     to_string(drive_node(cycle.bus(), i)), describe(state_of(cycle, i)), drive.statusword,
                     drive.emergency ? ": " : "", drive.emergency ? describe(*drive.emergency) : "",
                     advice_on_state(cycle.bus().drives[i].device, state_of(cycle, i), drive.emergency));
}

void wait_in_set_up(BusCycle& cycle) {
  if (!cycle.wait()) throw Error(HRT_E_CLOSED, "hrt_close() was called while the robot was being set up");
}

// No drive is commanded until all have been heard: the next step depends on a drive's state, and the step for an
// unpowered one would remove the torque of one that holds the robot.
void hear_all(BusCycle& cycle) {
  const Time until = cycle.master().now() + kPowerUp;
  for (std::size_t i = 0; i < cycle.bus().drives.size();) {
    if (cycle.image().drive(i).state_at) {
      ++i;
    } else if (cycle.master().now() > until) {
      throw Error(HRT_E_DEVICE, to_string(drive_node(cycle.bus(), i)) + " sends no process data");
    } else {
      wait_in_set_up(cycle);
    }
  }
}

// Runs cycle by cycle until `done` is true for all drives; `failure` describes it if that takes too long.
void run_until(BusCycle& cycle, Time patience, const std::function<DriveOrder(std::size_t)>& order,
               const std::function<bool(std::size_t)>& done, const std::function<std::string(std::size_t)>& failure) {
  const Time until = cycle.master().now() + patience;
  while (true) {
    wait_in_set_up(cycle);
    std::optional<std::size_t> missing;
    DriveOrders orders(cycle.bus().drives.size());
    for (std::size_t i = 0; i < cycle.bus().drives.size(); ++i) {
      orders[i] = order(i);
      if (!missing && !done(i)) missing = i;
    }
    if (missing && cycle.master().now() > until) throw Error(HRT_E_DEVICE, failure(*missing));
    cycle.send(orders);
    if (!missing) return;
  }
}

// A drive that gets each n-th order gets one of each n: an edge of a single cycle might never reach it.
std::uint16_t control_out_of_quick_stop(const canbus::Device& device, int cycles_in_it) {
  const int commands_before = (cycles_in_it - 1) / device.command_every;
  if (commands_before >= kHoldThroughQuickStop) return canopen::kControlDisableVoltage;
  return commands_before % kEdgeEachCommands == 0 ? canopen::kControlQuickStop : canopen::kControlEnable;
}

// A reset acts on the rising edge of bit 7. A drive may look at the controlword less often than it gets one.
std::uint16_t control_out_of_fault(const canbus::Device& device, int cycles_in_it) {
  const int cycles = device.fault_reset_cycles * device.command_every;
  return (cycles_in_it - 1) / cycles % 2 == 0 ? canopen::kControlFaultReset : std::uint16_t{0};
}

// Takes all drives to "switched on", or to "operation enabled"; those that are enabled already stay so.
void take_to(BusCycle& cycle, PowerState wanted) {
  const std::size_t drives = cycle.bus().drives.size();
  std::vector<int> cycles_in_quick_stop(drives), cycles_in_fault(drives);
  const auto controlword = [&](std::size_t i) {
    const PowerState state = state_of(cycle, i);
    if (state == PowerState::quick_stop_active)
      return control_out_of_quick_stop(device_of(cycle, i), ++cycles_in_quick_stop[i]);
    if (state == PowerState::fault) return control_out_of_fault(device_of(cycle, i), ++cycles_in_fault[i]);
    if (state == PowerState::switched_on && wanted == PowerState::switched_on) return canopen::kControlSwitchOn;
    return canopen::control_towards_operation(state, cycle.sent()[i].controlword);
  };
  run_until(
      cycle, kPowerUp,
      [&](std::size_t i) {
        return DriveOrder{controlword(i), hold_target(cycle, i)};
      },
      [&](std::size_t i) {
        const PowerState state = state_of(cycle, i);
        return state == wanted || state == PowerState::operation_enabled;
      },
      [&](std::size_t i) { return not_enabled(cycle, i); });
}

void enable_all(BusCycle& cycle) {
  take_to(cycle, PowerState::operation_enabled);
}

void write_step(BusCycle& cycle, std::size_t i, const canbus::SdoStep& step) try {
  cycle.master().write(drive_node(cycle.bus(), i), step.what);
} catch (const SdoRefused& refused) {
  throw Error(HRT_E_DEVICE, refused.what() + advice_on_refusal_when_enabled(device_of(cycle, i), refused));
}

// Waits until the drive shows the mode that was written.
void await_mode(BusCycle& cycle, std::size_t i, DriveMode mode) {
  const NamedNode node = drive_node(cycle.bus(), i);
  const canopen::SdoWrite shown = canbus::read_of_mode().what;
  const Time until = cycle.master().now() + kModeChange;
  while (cycle.master().read(node, {shown.object, shown.type}, shown.purpose) != static_cast<std::int64_t>(mode)) {
    if (cycle.master().now() > until)
      throw Error(HRT_E_DEVICE, fmt::format("{} did not switch to the mode {}{}", to_string(node), describe(mode),
                                            canbus::advice(device_of(cycle, i), "mode_change = \"disabled\"")));
  }
}

void write_mode(BusCycle& cycle, std::size_t i, DriveMode mode) {
  write_step(cycle, i, canbus::write_of_mode(mode));
  await_mode(cycle, i, mode);
}

// Commands have arrived, but the drives are not enabled: what can be set, or seen to be wrong, only now.
void check_before_enabling(BusCycle& cycle, std::size_t i) {
  const canbus::DriveOnBus& drive = cycle.bus().drives[i];
  if (drive.device.halt_blocks_mode) write_step(cycle, i, canbus::write_of_mode(first_mode(drive)));
  if (is_position(drive.mode)) return;
  const NamedNode node = drive_node(cycle.bus(), i);
  const canopen::SdoWrite target = canbus::read_of_target_velocity().what;
  const std::int64_t left_over = cycle.master().read_if_there(node, {target.object, target.type}).value_or(0);
  if (left_over != 0)
    throw Error(HRT_E_DEVICE,
                fmt::format("{}: its target velocity (object 0x60FF) is {} although 0 was commanded: it would run as "
                            "soon as it is enabled{}",
                            to_string(node), left_over, canbus::advice(drive.device, "zero_target_by_sdo = true")));
}

void begin_homing(BusCycle& cycle, std::size_t i) {
  const canbus::DriveOnBus& drive = cycle.bus().drives[i];
  for (const canbus::SdoStep& step : canbus::homing_of_drive(drive)) write_step(cycle, i, step);
  if (first_mode(drive) != DriveMode::homing) write_mode(cycle, i, DriveMode::homing);
}

// CiA 402 is ambiguous: at home the position is the home offset, or minus the offset. A flipper with the wrong sign of
// its angle would be driven to the wrong side of the robot.
void check_home(const BusCycle& cycle, std::size_t i) {
  const canbus::DriveOnBus& drive = cycle.bus().drives[i];
  const double home_rad = drive.homing->home_rad;
  const double measured_rad = position_from_drive(drive.units, cycle.image().drive(i).position);
  const double mirrored_rad = position_from_drive(drive.units, -position_to_drive(drive.units, home_rad));
  const bool stays = drive.homing->method == 35 || drive.homing->method == 37;
  // a drive that moves stops beyond its switch, or continues to a position its manufacturer chose: only a wrong sign
  // can be detected. The margin has twice the stopping distance, v^2 / (2 a).
  const double speed = drive.homing->speed_radps;
  const double twice_stopping_rad = speed * speed / drive.homing->acceleration_radps2;
  const double margin_rad = stays ? kHomeTolerance_rad : kHomeTolerance_rad + twice_stopping_rad;
  if (std::abs(measured_rad - home_rad) <= margin_rad) return;
  if (!stays && std::abs(measured_rad - mirrored_rad) > margin_rad) return;
  throw Error(
      HRT_E_DEVICE,
      fmt::format(
          "{}: reports {:.3f} rad after homing, not {:.3f} rad (home_rad); if its home offset (object 0x607C) "
          "has the opposite sign, set offset_direction = {} in [can.flipper.homing]{}",
          to_string(drive_node(cycle.bus(), i)), measured_rad, home_rad, -drive.homing->offset_direction,
          canbus::advice(drive.device, fmt::format("home_offset_direction = {}", -drive.homing->offset_direction))));
}

// Flippers go on in their own mode. A drive that changes its mode only when it is not enabled pauses meanwhile: its
// brake, or the gear, holds it.
void leave_homing(BusCycle& cycle) {
  const auto pauses = [&](std::size_t i) {
    return cycle.bus().drives[i].homing && device_of(cycle, i).mode_change == ModeChange::disabled;
  };
  const auto none = [&](std::size_t i) { return not_enabled(cycle, i); };
  bool any = false;
  for (std::size_t i = 0; i < cycle.bus().drives.size(); ++i) any = any || pauses(i);
  if (any) {
    run_until(
        cycle, kModeChange,
        [&](std::size_t i) {
          return DriveOrder{pauses(i) ? canopen::kControlSwitchOn : canopen::kControlEnable, hold_target(cycle, i)};
        },
        [&](std::size_t i) { return !pauses(i) || state_of(cycle, i) == PowerState::switched_on; }, none);
  }
  for (std::size_t i = 0; i < cycle.bus().drives.size(); ++i) {
    const canbus::DriveOnBus& drive = cycle.bus().drives[i];
    if (!drive.homing) continue;
    pauses(i) ? write_step(cycle, i, canbus::write_of_mode(drive.mode)) : write_mode(cycle, i, drive.mode);
  }
  if (!any) return;
  enable_all(cycle);
  for (std::size_t i = 0; i < cycle.bus().drives.size(); ++i) {
    if (pauses(i)) await_mode(cycle, i, cycle.bus().drives[i].mode);
  }
}

void home(BusCycle& cycle) {
  const auto homes = [&](std::size_t i) { return cycle.bus().drives[i].homing.has_value(); };
  double patience_s = 0;
  for (std::size_t i = 0; i < cycle.bus().drives.size(); ++i) {
    if (!homes(i)) continue;
    begin_homing(cycle, i);
    patience_s = std::max(patience_s, cycle.bus().drives[i].homing->patience_s);
  }
  if (patience_s == 0) return;
  // Homing moves the drive and gives its position another zero: it stays where it is then.
  const auto hold_or_home = [&](std::size_t i) { return homes(i) ? target_here(cycle, i) : hold_target(cycle, i); };
  const auto status = [&](std::size_t i) { return cycle.image().drive(i).statusword; };
  const Time believed_from = cycle.master().now() + kHomingBegins;
  const auto is_believed = [&] { return cycle.master().now() >= believed_from; };
  run_until(
      cycle, to_time(patience_s),
      [&](std::size_t i) {
        if (const std::optional<std::size_t> lost = cycle.lost_drive()) lose(cycle, *lost);
        if (homes(i) && (status(i) & canopen::kStatusError) != 0 && is_believed())
          throw Error(HRT_E_DEVICE, fmt::format("{}: homing failed (statusword {:#06x})",
                                                to_string(drive_node(cycle.bus(), i)), status(i)));
        const unsigned start = homes(i) ? canopen::kControlNewSetPoint : 0u;
        return DriveOrder{static_cast<std::uint16_t>(canopen::kControlEnable | start), hold_or_home(i)};
      },
      [&](std::size_t i) {
        constexpr unsigned kDone = canopen::kStatusHomingAttained | canopen::kStatusTargetReached;
        return !homes(i) || (is_believed() && (status(i) & kDone) == kDone);
      },
      [&](std::size_t i) {
        return fmt::format("{} was not home within {} s (statusword {:#06x})", to_string(drive_node(cycle.bus(), i)),
                           patience_s, status(i));
      });
  // In profile position mode bit 4 is a new set-point: it must be low, and seen as low, before the mode changes. So
  // these orders, without it, are sent in three cycles, or three of the drive that takes them least often. run_until
  // asks for drive 0 first, and once in each cycle.
  constexpr int kCommandsLow = 3;
  int cycles_low = 0, cycles_of_command = 1;
  for (const canbus::DriveOnBus& drive : cycle.bus().drives)
    cycles_of_command = std::max(cycles_of_command, drive.device.command_every);
  run_until(
      cycle, kModeChange,
      [&](std::size_t i) {
        return DriveOrder{canopen::kControlEnable, hold_or_home(i)};
      },
      [&](std::size_t i) {
        if (i == 0) ++cycles_low;
        return cycles_low >= kCommandsLow * cycles_of_command;
      },
      [&](std::size_t i) { return not_enabled(cycle, i); });
  for (std::size_t i = 0; i < cycle.bus().drives.size(); ++i) {
    if (homes(i)) check_home(cycle, i);
  }
  leave_homing(cycle);
}

bool is_at_rest(const BusCycle& cycle, std::size_t track) {
  const canbus::DriveOnBus& drive = cycle.bus().drives[track];
  return std::abs(velocity_from_drive(drive.units, cycle.image().drive(track).velocity)) < canbus::kAtRest_mps;
}

std::string not_stopped(const BusCycle& cycle, std::size_t i,
                        const std::function<bool(const std::optional<Time>&)>& is_new) {
  const std::string name = to_string(drive_node(cycle.bus(), i));
  if (!is_new(cycle.image().drive(i).state_at)) return name + " is silent";
  const PowerState state = state_of(cycle, i);
  if (state != PowerState::operation_enabled) return name + " still runs";
  return fmt::format("{} stays in the state \"{}\"", name, describe(state));
}

DriveOrders orders_to_stop(const BusCycle& cycle) {
  DriveOrders orders(cycle.bus().drives.size());
  for (std::size_t i = 0; i < cycle.bus().drives.size(); ++i)
    orders[i] = {canopen::kControlQuickStop, target_here(cycle, i)};
  return orders;
}

// How long a drive may take to stop that misses its order to, and so stops when its event timer ends.
double longest_power_down_s(const BusCycle& cycle) {
  double longest_s = kShortestPowerDown_s;
  for (std::size_t i = 0; i < cycle.bus().drives.size(); ++i) {
    const double gap_s = longest_command_gap_s(cycle.bus(), i, cycle.period_s());
    longest_s = std::max(longest_s, longest_stop_s(cycle.bus(), gap_s) + kStopShows_s);
  }
  return longest_s;
}

// A drive that has stopped as ordered stays in "quick stop active" and holds (0x605A = 6).
std::string no_torque(const BusCycle& cycle, std::size_t i) {
  const DriveInput& drive = cycle.image().drive(i);
  return fmt::format("{} is in the state \"{}\" (statusword {:#06x}){}{}{}", to_string(drive_node(cycle.bus(), i)),
                     describe(state_of(cycle, i)), drive.statusword, drive.emergency ? ": " : "",
                     drive.emergency ? describe(*drive.emergency) : "",
                     advice_on_emergency(device_of(cycle, i), drive.emergency));
}

void add_to(std::string& list, const std::string& what) {
  list += (list.empty() ? "" : ", ") + what;
}

}  // namespace

void power_up(BusCycle& cycle) try {
  hear_all(cycle);
  take_to(cycle, PowerState::switched_on);
  for (std::size_t i = 0; i < cycle.bus().drives.size(); ++i) check_before_enabling(cycle, i);
  enable_all(cycle);
  cycle.watch_restarts();
  for (std::size_t i = 0; i < cycle.bus().drives.size(); ++i) {
    const DriveMode mode = first_mode(cycle.bus().drives[i]);
    device_of(cycle, i).mode_change == ModeChange::enabled ? write_mode(cycle, i, mode) : await_mode(cycle, i, mode);
  }
  home(cycle);
  cycle.watch_jumps();
} catch (const Error&) {
  try_quick_stop(cycle);  // enabled drives, possibly moving home, must not wait until they miss the heartbeat
  throw;
}

void quick_stop(BusCycle& cycle) {
  cycle.send_at_once(orders_to_stop(cycle));
}

void try_quick_stop(BusCycle& cycle) try { quick_stop(cycle); } catch (const std::exception&) {
}

void lose(BusCycle& cycle, std::size_t drive) {
  quick_stop(cycle);
  const std::string loss = cycle.loss_of(drive);
  Master& master = cycle.master();
  master.wait_until(master.now() + kEmergencyFollows, [&] { return !cycle.emergency_of(drive).empty(); });
  const std::string emergency = cycle.emergency_of(drive);
  const std::string advice = advice_on_emergency(device_of(cycle, drive), cycle.image().drive(drive).emergency);
  throw Error(
      HRT_E_DEVICE,
      fmt::format(
          "{}{}{}{}; all drives were commanded to stop; to start them again, call hrt_close(), then hrt_kenaf_init()",
          loss, emergency.empty() ? "" : ": ", emergency, advice));
}

NotHeld power_down(BusCycle& cycle) {
  const std::size_t drives = cycle.bus().drives.size();
  const Time begin = cycle.master().now(), until = begin + to_time(longest_power_down_s(cycle));
  const auto is_new = [&](const std::optional<Time>& at) { return at && *at > begin; };
  const auto has_stopped = [&](std::size_t i) {
    const DriveInput& drive = cycle.image().drive(i);
    const bool left = is_new(drive.state_at) && state_of(cycle, i) != PowerState::operation_enabled;
    return left && (cycle.bus().drives[i].is_flipper() || (is_new(drive.effort_at) && is_at_rest(cycle, i)));
  };

  // Repeated in each cycle, since a frame may not reach every drive, but in the turn of drives that take few commands:
  // a fault for one too many would take the torque from flippers that carry the robot.
  NotHeld result;
  std::vector<std::size_t> stopped;
  do {
    cycle.send(orders_to_stop(cycle));
    cycle.wait();
    result.running.clear();
    stopped.clear();
    for (std::size_t i = 0; i < drives; ++i) {
      if (has_stopped(i))
        stopped.push_back(i);
      else
        add_to(result.running, not_stopped(cycle, i, is_new));
    }
  } while (!result.running.empty() && cycle.master().now() < until);

  end_watches(cycle, stopped, orders_to_stop(cycle));
  for (const std::size_t i : stopped) {
    if (state_of(cycle, i) != PowerState::quick_stop_active) add_to(result.without_torque, no_torque(cycle, i));
  }
  return result;
}

}  // namespace kenaf::real
