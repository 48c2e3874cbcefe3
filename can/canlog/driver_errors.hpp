// Messages of a CAN driver about the wire, in the form of Linux (linux/can/error.h): a class of bits, and eight bytes.
// Pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "can/canopen/recorded_frame.hpp"

namespace kenaf::canlog {

// ISO 11898-1, fault confinement: warning from 96 errors, passive from 128; bus-off from 256, when the controller takes
// no further part.
struct DriverError {
  bool bus_off = false, passive = false, warning = false, active = false, overflow = false;
  bool is_protocol = false;
  std::uint8_t protocol = 0;  // bits: 1 bit, 2 form, 4 stuff; 0: another
  std::optional<std::uint8_t> send_count{}, receive_count{};
};

// Sets kind, error class and bytes of `line`.
void set_error(canopen::RecordedFrame& line, const DriverError& error);

bool is_bus_off(std::uint32_t error_class);

// "bus-off", "error warning, receiving; error counters 106 sending, 127 receiving", "arbitration lost at bit 5".
std::string driver_error_words(std::uint32_t error_class, const canopen::Frame& frame);

}  // namespace kenaf::canlog
