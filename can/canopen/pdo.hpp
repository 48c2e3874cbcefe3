// Process data objects: contents of a frame of the control loop, and the writes that make a node send or receive it.
// CiA 301, 7.2.2 (PDO), 7.5.2.35 to 38 (objects 0x1400, 0x1600, 0x1800, 0x1A00).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "can/canopen/nmt.hpp"
#include "can/canopen/object.hpp"

namespace kenaf::canopen {

// One object in a PDO. Mapped in list order, from bit 0 of byte 0, without gaps.
struct MappedObject {
  ObjectAddress object;
  ObjectType type;  // not text
};

// As seen by the node: it transmits to the master or receives from it.
enum class PdoDirection : std::uint8_t { transmit, receive };

// Transmission types: 1 to 240 = transmitted at every n-th SYNC; a received PDO takes effect at the next SYNC; 255 =
// event-driven.
struct Pdo {
  PdoDirection direction;
  std::uint8_t number;  // 1 to 4: the predefined connection set has an identifier for each
  std::uint8_t transmission;
  std::vector<MappedObject> objects;  // at most 64 bits together
};

// As in the mapping objects, 0x1600 and 0x1A00: index, sub-index and length in bits.
std::uint32_t mapping_entry(const MappedObject& mapped);
std::uint16_t cob_id(const Pdo& pdo, NodeId node);
// Bits of the COB-ID entry, 0x1400 and 0x1800 sub-index 1, in addition to the identifier.
constexpr std::uint32_t kPdoInvalid = 1u << 31;          // the PDO does not exist
constexpr std::uint32_t kPdoNoRemoteRequest = 1u << 30;  // for a transmit PDO; reserved, 0, for a receive PDO
std::uint8_t byte_count(const Pdo& pdo);

// The values in the order of pdo.objects; throws std::out_of_range if one does not fit its type.
Frame pack(const Pdo& pdo, NodeId node, std::span<const std::int64_t> values);
// Returns false and changes nothing if the frame has another length than the PDO (CiA 301 would let a node take the
// first bytes of a longer one, but that is not the PDO that was mapped). `values` has one element for each object.
bool unpack(const Pdo& pdo, const Frame& frame, std::span<std::int64_t> values);

// One object to be written by SDO, and its purpose for error messages: "mapping of TPDO1".
struct SdoWrite {
  ObjectAddress object;
  ObjectType type;
  std::int64_t value;
  std::string purpose;
};

// CiA 301, 7.5.2.36: the PDO is made invalid (bit 31 of sub-index 1), its mapping cleared, written and counted, and
// then the PDO made valid again. Bit 30 (no remote request) is set for transmit PDOs.
std::vector<SdoWrite> configuration_of(const Pdo& pdo, NodeId node);

}  // namespace kenaf::canopen
