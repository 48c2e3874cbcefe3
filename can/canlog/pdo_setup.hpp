// The configuration of the nodes' PDOs, tracked from the writes to them: which identifier carries what now, and the
// rule about the order of the writes. CiA 301, 7.5.2.35 to 38.
//
// A PDO is as the log has set it up; where the log does not tell, as in the description. The order of writes is judged
// from a node's reset on, or from the write that makes the PDO invalid: what came before the log may have prepared it.
#pragma once

#include <map>
#include <optional>
#include <set>

#include "can/canlog/findings.hpp"
#include "can/canlog/pdo_in_force.hpp"

namespace kenaf::canlog {

class PdoSetup {
 public:
  // All arguments must outlive this.
  PdoSetup(const Network& network, Findings& findings);

  void on_write(const LogFrame& logged, const WrittenObject& written);
  void on_restart(canopen::NodeId node);
  // The node becomes operational: its PDOs are in use from now on.
  void on_start(const LogFrame& logged, canopen::NodeId node);

  // The PDOs by their identifiers, as they are now. Where one node's transmit PDO is another's receive PDO, the former.
  const std::map<std::uint16_t, PdoInForce>& in_force() const { return in_force_; }
  const PdoInForce* pdo(std::uint16_t cob_id) const;
  // As canlog::address_of, but for PDOs where they are now.
  Address address_of(std::uint16_t cob_id) const;
  // The log has moved the PDO away from this identifier of the predefined connection set, or made it invalid.
  bool is_given_up(std::uint16_t cob_id) const;

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
    bool no_remote = false;
    std::optional<std::uint8_t> transmission{};
    std::optional<std::uint8_t> count{};
    std::map<std::uint8_t, std::uint32_t> entries{};
    bool mapped = false;  // the mapping was written, in any order
  };
  static std::optional<Key> key_of(const WrittenObject& written);
  static std::optional<Key> predefined(std::uint16_t cob_id);
  static std::optional<std::uint16_t> predefined_id(const Key& key);
  static std::string name(const Key& key, const Network& network);
  void write_communication(const LogFrame& logged, const Key& key, const WrittenObject& written);
  void write_identifier(const LogFrame& logged, const Key& key, std::uint32_t value);
  void write_mapping(const LogFrame& logged, const Key& key, const WrittenObject& written);

  const Record* record(const Key& key) const;
  void claim(const Key& key, const Record& record);
  void give_up(const Key& key, const Record& record);
  void update(const Key& key);
  void update(std::uint16_t cob_id);
  std::optional<Key> owner_of(std::uint16_t cob_id) const;
  PdoInForce made_from(const Key& key) const;

  const Network& network_;
  Findings& findings_;
  std::set<canopen::NodeId> reset_;  // since the log's beginning
  std::map<Key, Record> records_;
  std::map<std::uint16_t, std::set<Key>> claims_;  // by written identifiers
  std::map<std::uint16_t, PdoInForce> in_force_;
};

}  // namespace kenaf::canlog
