// The configuration of the nodes' PDOs, tracked from the writes to them, and the rule about its order. CiA 301,
// 7.5.2.35 to 38.
#pragma once

#include <map>
#include <optional>

#include "can/canlog/findings.hpp"

namespace kenaf::canlog {

class PdoSetup {
 public:
  // All arguments must outlive this.
  PdoSetup(const Network& network, Findings& findings) : network_(network), findings_(findings) {}

  void on_write(const LogFrame& logged, const WrittenObject& written);
  void on_restart(canopen::NodeId node);
  // The node becomes operational: its PDOs are in use from now on.
  void on_start(const LogFrame& logged, canopen::NodeId node);

  // As mapped in this log, otherwise as in the layout; nullopt: not in the layout, or left to the device.
  std::optional<std::size_t> mapped_bytes(std::uint16_t cob_id) const;
  // 1 to 240: at every n-th SYNC. nullopt: neither written nor in the layout.
  std::optional<std::uint8_t> transmission(std::uint16_t cob_id) const;

 private:
  struct Key {
    canopen::NodeId node;
    bool transmit;
    unsigned number;  // counted from 1
    auto operator<=>(const Key&) const = default;
  };
  struct Record {
    std::optional<bool> valid{};
    std::optional<std::uint32_t> id{};
    std::optional<std::uint8_t> transmission{};
    std::optional<std::uint8_t> count{};
    std::map<std::uint8_t, std::uint32_t> entries{};
    bool mapped = false;  // the mapping was written, in any order
  };
  static std::optional<Key> key_of(const WrittenObject& written);
  static std::string name(const Key& key, const Network& network);
  void write_communication(const LogFrame& logged, const Key& key, const WrittenObject& written);
  void write_mapping(const LogFrame& logged, const Key& key, const WrittenObject& written);
  const Record* record(std::uint16_t cob_id) const;

  const Network& network_;
  Findings& findings_;
  std::map<Key, Record> records_;
};

}  // namespace kenaf::canlog
