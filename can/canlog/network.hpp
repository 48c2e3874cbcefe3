// The meaning of an identifier on the bus: service and node by CiA 301's predefined connection set (7.3.3 to 7.3.5),
// the node's name and process data by the robot's description.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "can/canbus/bus_layout.hpp"
#include "can/canbus/robot_bus.hpp"

namespace kenaf::canlog {

enum class Service : std::uint8_t {
  nmt,
  sync,
  time_stamp,
  emergency,
  transmit_pdo,  // by a node
  receive_pdo,   // to a node
  sdo_answer,    // by a node
  sdo_request,   // to a node
  heartbeat,     // of a node, or guarding of it
  lss_request,   // to nodes that are being set up: CiA 305
  lss_answer,
  none,  // no identifier of the predefined connection set
};

struct Address {
  Service service;
  canopen::NodeId node;  // 0: no single node
  std::uint16_t pdo;     // 1 to 512, for a PDO
};
Address address_of(std::uint16_t cob_id);

// One of the robot's PDOs: its contents, and the drive it belongs to.
struct KnownPdo {
  canopen::Pdo pdo;  // for the gyro: no objects, since its device determines the rest of the frame
  canopen::NodeId node;
  std::optional<std::size_t> drive;
};

class Network {
 public:
  explicit Network(const canbus::RobotBus& bus);

  const canbus::RobotBus& bus() const { return bus_; }
  bool is_known(canopen::NodeId node) const { return names_.contains(node); }
  bool is_master(canopen::NodeId node) const { return node == bus_.master; }
  bool is_other(canopen::NodeId node) const;  // a device of somebody else, which [[can.other]] names
  // "flipper front left"; "node 9" for a node that the description does not know.
  std::string name(canopen::NodeId node) const;
  // Includes the master.
  const std::map<canopen::NodeId, std::string>& names() const { return names_; }

  const std::map<std::uint16_t, KnownPdo>& pdos() const { return pdos_; }
  const KnownPdo* pdo(std::uint16_t cob_id) const;
  std::optional<std::size_t> drive_of(canopen::NodeId node) const;
  bool is_gyro(std::uint16_t cob_id) const;

 private:
  void add(const canopen::Pdo& pdo, canopen::NodeId node, std::optional<std::size_t> drive);

  canbus::RobotBus bus_;
  std::map<canopen::NodeId, std::string> names_;
  std::map<std::uint16_t, KnownPdo> pdos_;
};

}  // namespace kenaf::canlog
