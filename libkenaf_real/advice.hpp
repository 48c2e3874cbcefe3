// Which key of a device file a refusal of a drive, or its state, suggests. For the ends of error messages; "" where
// there is nothing to suggest.
//
// Thread safety: pure functions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "can/canbus/robot_bus.hpp"
#include "can/canopen/emergency.hpp"
#include "libkenaf_real/master.hpp"

namespace kenaf::real {

// During set-up, before the drive is enabled.
std::string advice_on_refusal(const canbus::Device& device, const SdoRefused& refused);
std::string advice_on_refusal_when_enabled(const canbus::Device& device, const SdoRefused& refused);
// For a drive that cannot be enabled, and for one that has left operation by itself.
std::string advice_on_state(const canbus::Device& device, canopen::PowerState state,
                            const std::optional<canopen::Emergency>& emergency);
std::string advice_on_emergency(const canbus::Device& device, const std::optional<canopen::Emergency>& emergency);
std::string advice_on_boot(const canbus::RobotBus& bus, const std::vector<NamedNode>& missing);

}  // namespace kenaf::real
