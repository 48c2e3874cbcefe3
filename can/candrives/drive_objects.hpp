// The object dictionary of the simulated drives beyond what every node has, and the PDOs that they come with.
#pragma once

#include <vector>

#include "can/candrives/dictionary.hpp"
#include "can/candrives/process_data.hpp"
#include "can/canopen/drive.hpp"

namespace kenaf::candrives {

// Those of the profile that a master of this project has no use for, but a drive has.
namespace object {
using namespace canopen::object;
using canopen::MappedObject;
using canopen::ObjectType;
inline constexpr MappedObject shutdown_option{{0x605b, 0}, ObjectType::integer16},
    disable_operation_option{{0x605c, 0}, ObjectType::integer16},
    following_error_window{{0x6065, 0}, ObjectType::unsigned32},
    following_error_timeout_ms{{0x6066, 0}, ObjectType::unsigned16},
    position_window{{0x6067, 0}, ObjectType::unsigned32}, velocity_window{{0x606d, 0}, ObjectType::unsigned16},
    velocity_threshold{{0x606f, 0}, ObjectType::unsigned16}, following_error{{0x60f4, 0}, ObjectType::integer32};
}  // namespace object

// Quick stop option codes, object 0x605a, that the drives have beside kQuickStopAndStay.
inline constexpr std::int16_t kDisableDrive = 0, kSlowDownRamp = 1, kQuickStopRamp = 2, kSlowDownAndStay = 5;
// Abort connection option codes, object 0x6007, beside kAbortByQuickStop.
inline constexpr std::int16_t kAbortNoAction = 0, kAbortByFault = 1, kAbortByDisableVoltage = 2;

// What CiA 402 leaves to the drive: 0x6078 with 0x6075, and 0x6079.
struct OptionalDriveObjects {
  bool current, voltage;
};
// Values are as from a factory: gentle ramps, low speeds. What fits the robot its master writes.
void add_drive_objects(Dictionary& objects, OptionalDriveObjects has);

// CiA 402-2, default PDO mapping: the controlword and what goes with it, the statusword and what goes with it. Only the
// first of each kind is valid at first.
std::vector<DefaultPdo> drive_pdos();

// nullopt: the profile and these drives know the value. Limits of a number are in its entry already.
std::optional<canopen::SdoAbort> check_drive_object(canopen::ObjectAddress object, std::int64_t value);

}  // namespace kenaf::candrives
