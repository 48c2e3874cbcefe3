// Translates what the rooms below libkenaf_real throw into the hrt::Error that a program sees. No
// other place chooses its code.
//
//   DescriptionError  HRT_E_CONFIG   the robot's file, with line and column
//   NoBus             HRT_E_DEVICE   there is no such CAN interface, or it is down
//   BusError          HRT_E_LINK     a bus that worked no longer does
//
// The text stays. hrt::Error, and all else, passes. Thread safety: any thread.
#pragma once

#include <utility>

#include "can/canbus/socket_bus.hpp"
#include "can/canopen/bus.hpp"
#include "formats/description/description_error.hpp"
#include "hrt/error.hpp"

namespace kenaf::real {

// Returns what `body` returns.
template <typename Body>
auto with_translated_errors(Body&& body) {
  try {
    return std::forward<Body>(body)();
  } catch (const description::DescriptionError& error) {
    throw hrt::Error(HRT_E_CONFIG, error.what());
  } catch (const canbus::NoBus& error) {
    throw hrt::Error(HRT_E_DEVICE, error.what());
  } catch (const canopen::BusError& error) {
    throw hrt::Error(HRT_E_LINK, error.what());
  }
}

}  // namespace kenaf::real
