// Describes the frames of SDO transfers, eight bytes each. CiA 301, 7.2.4.3.
#pragma once

#include <string>

#include "can/canopen/frame.hpp"

namespace kenaf::canlog {

std::string sdo_request_words(const canopen::Frame& frame,
                              const std::string& node);  // "SDO read 0x6041:00 (statusword) from NODE"
std::string sdo_answer_words(const canopen::Frame& frame,
                             const std::string& node);  // "SDO answer of NODE: 0x6041:00 (statusword) = 0x0637"

}  // namespace kenaf::canlog
