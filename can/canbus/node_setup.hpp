// All that the master reads and writes by SDO, in its order: the only list of it. The library carries it out
// (libkenaf_real/commissioning.cpp, power.cpp), and kenaf-canlog compares it with a drive's electronic data sheet.
//
// Thread safety: values and pure functions.
#pragma once

#include <optional>
#include <vector>

#include "can/canbus/robot_bus.hpp"
#include "can/canopen/pdo.hpp"

namespace kenaf::canbus {

struct SdoStep {
  enum class Kind : std::uint8_t {
    write,   // what.value
    read,    // what.value has no meaning
    expect,  // reads, and what it finds must be what.value: parts of a mapping that cannot be written
  };
  canopen::SdoWrite what;
  Kind kind = Kind::write;
  bool optional = false;  // a node that has no such object is set up without it
};

// From pre-operational to operational: identity, parameters, PDOs, heartbeats.
std::vector<SdoStep> set_up_of_drive(const RobotBus& bus, std::size_t drive, double period_s);
std::vector<SdoStep> set_up_of_inclinometer(const RobotBus& bus);
// For one that counts in thousandths of a degree (0x6000 = 1): its 16-bit slopes would end at 32.767 degrees, and what
// lies beyond would be saturated or wrapped. In hundredths they reach 327.67.
SdoStep write_of_slope_resolution();
inline constexpr std::int64_t kTooFineSlope = 1, kSlopeInHundredths = 10;  // 0x6000: thousandths of a degree

// For a flipper with homing, before its mode becomes homing.
std::vector<SdoStep> homing_of_drive(const DriveOnBus& drive);
// The mode, written, and the object that shows it in force, which follows it.
SdoStep write_of_mode(canopen::DriveMode mode);
SdoStep read_of_mode();
// Object 0x60FF as the drive has it, for tracks: some take it from PDOs only once they are enabled.
SdoStep read_of_target_velocity();
// The two watches for the master (libkenaf_real/drive_watches.hpp). A drive that is asked by node guarding watches from
// its set-up on: nullopt. The second ends the first: the drive holds its position after hrt_close.
std::optional<SdoStep> begin_of_watch(const RobotBus& bus, const Device& device);
SdoStep end_of_watch(const Device& device);
// Milliseconds without the command, by the event timer of its RPDO; 0: any.
SdoStep read_of_event_timer(const canopen::Pdo& command);
SdoStep write_of_event_timer(const canopen::Pdo& command, std::int64_t ms);

// All of the above for a drive.
std::vector<SdoStep> all_steps_of_drive(const RobotBus& bus, std::size_t drive, double period_s);

}  // namespace kenaf::canbus
