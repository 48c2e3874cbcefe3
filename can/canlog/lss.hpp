// Layer setting services: how nodes get their numbers and their bit rate. CiA 305, command specifiers.
#pragma once

#include <string>

#include "can/canopen/frame.hpp"

namespace kenaf::canlog {

inline constexpr std::uint16_t kLssRequestId = 0x7e5, kLssAnswerId = 0x7e4;

// "LSS switch state global: configuration", "LSS answer: inquire node id: 5". For a frame of either identifier.
std::string lss_words(const canopen::Frame& frame);

}  // namespace kenaf::canlog
