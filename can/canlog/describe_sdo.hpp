// Describes the frames of SDO transfers, eight bytes each. CiA 301, 7.2.4.3.
#pragma once

#include <string>

#include "can/canlog/sdo_block.hpp"
#include "can/canopen/frame.hpp"

namespace kenaf::canlog {

std::string sdo_request_words(const canopen::Frame& frame,
                              const std::string& node);  // "SDO read 0x6041:00 (statusword) from NODE"
std::string sdo_answer_words(const canopen::Frame& frame,
                             const std::string& node);  // "SDO answer of NODE: 0x6041:00 (statusword) = 0x0637"

// A segment of a block transfer, by its sender: the node (`by_node`) or the master.
std::string block_segment_words(const canopen::Frame& frame, const std::string& node, bool by_node);
// The frame that ends a block transfer: "SDO block end to NODE: 0x1f50:01 (program data, 1) = "ABC", 3 bytes, CRC
// 0x3994". `block` has taken it.
std::string block_end_words(const SdoBlock& block, const canopen::Frame& frame, const std::string& node);

}  // namespace kenaf::canlog
