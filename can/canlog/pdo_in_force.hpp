// A PDO as it is at some moment of a log: whose it is, and what its frames contain.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "can/canopen/pdo.hpp"

namespace kenaf::canlog {

struct PdoInForce {
  canopen::NodeId node;
  bool transmit;
  std::uint16_t number;                          // 1 to 512
  std::optional<std::size_t> drive{};            // of the node
  std::vector<canopen::MappedObject> objects{};  // empty: unknown, or not all of 1, 2 or 4 bytes
  std::optional<std::size_t> bytes{};            // nullopt: unknown, or left to the device
  std::optional<std::uint8_t> transmission{};    // 1 to 240: at every n-th SYNC
  bool no_remote = false;                        // remote requests are forbidden
  bool is_gyro = false;                          // its device determines the contents
};

// An entry of a mapping object: index, sub-index, bits. The type is that of CiA 402 and CiA 410, otherwise unsigned;
// nullopt: not 1, 2 or 4 bytes.
std::optional<canopen::MappedObject> mapped_object(std::uint32_t entry);

// The values in the order of the objects, at most eight; empty: the objects are unknown, or the frame has another
// length.
std::vector<std::int64_t> values_of(const PdoInForce& pdo, const canopen::Frame& frame);
// The value of one object; nullopt: it is not in the frame.
std::optional<std::int64_t> value_of(const PdoInForce& pdo, const canopen::Frame& frame, canopen::ObjectAddress object);

}  // namespace kenaf::canlog
