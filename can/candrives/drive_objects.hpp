// The object dictionary of the simulated drives beyond the common objects, and their default PDOs.
#pragma once

#include <vector>

#include "can/candrives/dictionary.hpp"
#include "can/candrives/process_data.hpp"
#include "can/canopen/drive.hpp"

namespace kenaf::candrives {

// Objects of the profile that drives have but this project's master does not use.
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

// Quick stop option codes, object 0x605a, supported in addition to kQuickStopAndStay.
inline constexpr std::int16_t kDisableDrive = 0, kSlowDownRamp = 1, kQuickStopRamp = 2, kSlowDownAndStay = 5;
// Abort connection option codes, object 0x6007, in addition to kAbortByQuickStop.
inline constexpr std::int16_t kAbortNoAction = 0, kAbortByFault = 1, kAbortByDisableVoltage = 2;

// Objects that CiA 402 leaves optional: 0x6078 with 0x6075, and 0x6079.
struct OptionalDriveObjects {
  bool current, voltage;
};
// Values are factory defaults: gentle ramps, low speeds. The master writes those that fit the robot.
void add_drive_objects(Dictionary& objects, OptionalDriveObjects has);

// CiA 402-2, default PDO mapping: the controlword and its companions, the statusword and its companions. Initially only
// the first of each kind is valid.
std::vector<DefaultPdo> drive_pdos(bool has_event_timer);

// nullopt: the profile and these drives support the value. Numeric limits are already in its entry.
std::optional<canopen::SdoAbort> check_drive_object(canopen::ObjectAddress object, std::int64_t value);

}  // namespace kenaf::candrives
