#include "can/canopen/pdo.hpp"

#include <fmt/format.h>

namespace kenaf::canopen {

std::uint32_t mapping_entry(const MappedObject& mapped) {
  return static_cast<std::uint32_t>(mapped.object.index) << 16 | static_cast<std::uint32_t>(mapped.object.sub) << 8 |
         static_cast<std::uint32_t>(8 * byte_count(mapped.type));
}

std::uint16_t cob_id(const Pdo& pdo, NodeId node) {
  const auto& first = pdo.direction == PdoDirection::transmit ? kTransmitPdoId : kReceivePdoId;
  return static_cast<std::uint16_t>(first[pdo.number - 1] + node);
}

std::uint8_t byte_count(const Pdo& pdo) {
  std::size_t bytes = 0;
  for (const MappedObject& mapped : pdo.objects) bytes += byte_count(mapped.type);
  return static_cast<std::uint8_t>(bytes);
}

Frame pack(const Pdo& pdo, NodeId node, std::span<const std::int64_t> values) {
  // in the control loop, so without allocating
  Frame frame{.id = cob_id(pdo, node), .length = byte_count(pdo)};
  std::span<std::uint8_t> rest = std::span(frame.data).first(frame.length);
  for (std::size_t i = 0; i < pdo.objects.size(); ++i)
    rest = rest.subspan(write_number(pdo.objects[i].type, values[i], rest));
  return frame;
}

bool unpack(const Pdo& pdo, const Frame& frame, std::span<std::int64_t> values) {
  if (frame.length != byte_count(pdo)) return false;
  std::span<const std::uint8_t> rest = frame.data;
  for (std::size_t i = 0; i < pdo.objects.size(); ++i) {
    values[i] = decode_number(pdo.objects[i].type, rest);
    rest = rest.subspan(byte_count(pdo.objects[i].type));
  }
  return true;
}

std::vector<SdoWrite> configuration_of(const Pdo& pdo, NodeId node) {
  const bool transmit = pdo.direction == PdoDirection::transmit;
  const std::string name = fmt::format("{}PDO{}", transmit ? 'T' : 'R', pdo.number);
  const auto communication = static_cast<std::uint16_t>((transmit ? 0x1800 : 0x1400) + pdo.number - 1);
  const auto mapping = static_cast<std::uint16_t>((transmit ? 0x1a00 : 0x1600) + pdo.number - 1);
  const std::uint32_t id = cob_id(pdo, node) | (transmit ? kPdoNoRemoteRequest : 0);

  std::vector<SdoWrite> writes{
      {{communication, 1}, ObjectType::unsigned32, id | kPdoInvalid, "switching " + name + " off"},
      {{communication, 2}, ObjectType::unsigned8, pdo.transmission, "transmission type of " + name},
      {{mapping, 0}, ObjectType::unsigned8, 0, "emptying the mapping of " + name},
  };
  std::uint8_t sub = 0;
  for (const MappedObject& mapped : pdo.objects)
    writes.push_back({{mapping, ++sub},
                      ObjectType::unsigned32,
                      mapping_entry(mapped),
                      "mapping of " + to_string(mapped.object) + " in " + name});
  writes.push_back({{mapping, 0}, ObjectType::unsigned8, sub, "closing the mapping of " + name});
  writes.push_back({{communication, 1}, ObjectType::unsigned32, id, "switching " + name + " on"});
  return writes;
}

}  // namespace kenaf::canopen
