#include "can/canlog/network.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "can/canlog/lss.hpp"

namespace kenaf::canlog {

using canopen::NodeId;
using canopen::Pdo;

namespace {

struct Range {
  std::uint16_t base;  // plus the node id: the identifier
  Service service;
  std::uint8_t pdo = 0;
};

// CiA 301, generic predefined connection set: tables 39 and 40.
constexpr Range kRanges[] = {
    {canopen::kEmergencyId, Service::emergency},          {canopen::kTransmitPdoId[0], Service::transmit_pdo, 1},
    {canopen::kReceivePdoId[0], Service::receive_pdo, 1}, {canopen::kTransmitPdoId[1], Service::transmit_pdo, 2},
    {canopen::kReceivePdoId[1], Service::receive_pdo, 2}, {canopen::kTransmitPdoId[2], Service::transmit_pdo, 3},
    {canopen::kReceivePdoId[2], Service::receive_pdo, 3}, {canopen::kTransmitPdoId[3], Service::transmit_pdo, 4},
    {canopen::kReceivePdoId[3], Service::receive_pdo, 4}, {canopen::kSdoResponseId, Service::sdo_answer},
    {canopen::kSdoRequestId, Service::sdo_request},       {canopen::kHeartbeatId, Service::heartbeat},
};
constexpr std::uint16_t kTimeId = 0x100;

}  // namespace

Address address_of(std::uint16_t cob_id) {
  if (cob_id == canopen::kNmtCommandId) return {Service::nmt, 0, 0};
  if (cob_id == canopen::kSyncId) return {Service::sync, 0, 0};
  if (cob_id == kTimeId) return {Service::time_stamp, 0, 0};
  if (cob_id == kLssRequestId) return {Service::lss_request, 0, 0};
  if (cob_id == kLssAnswerId) return {Service::lss_answer, 0, 0};
  for (const Range& range : kRanges) {
    if (cob_id > range.base && cob_id <= range.base + canopen::kMaxNode)
      return {range.service, static_cast<NodeId>(cob_id - range.base), range.pdo};
  }
  return {Service::none, 0, 0};
}

Network::Network(const canbus::RobotBus& bus) : bus_(bus) {
  names_[bus.master] = "master";
  for (std::size_t i = 0; i < bus.drives.size(); ++i) {
    const NodeId node = bus.drives[i].node;
    names_[node] = bus.drives[i].name;
    const canbus::DrivePdos pdos = canbus::pdos_of(bus, i);
    add(pdos.state, node, i);
    if (pdos.has_effort) add(pdos.effort, node, i);
    if (pdos.has_battery) add(pdos.battery, node, i);
    add(pdos.command, node, i);
  }
  if (bus.inclinometer) {
    names_[bus.inclinometer->node] = "inclinometer";
    add(canbus::inclinometer_pdo(), bus.inclinometer->node, std::nullopt);
  }
  if (bus.gyro) {
    names_[bus.gyro->node] = "gyro";
    add({canopen::PdoDirection::transmit, bus.gyro->pdo, 1, {}}, bus.gyro->node, std::nullopt);
  }
  for (const canbus::OtherOnBus& other : bus.others) names_[other.node] = other.name;
}

bool Network::is_other(NodeId node) const {
  return std::ranges::find(bus_.others, node, &canbus::OtherOnBus::node) != bus_.others.end();
}

void Network::add(const Pdo& pdo, NodeId node, std::optional<std::size_t> drive) {
  pdos_.emplace(cob_id(pdo, node), KnownPdo{pdo, node, drive});
}

std::string Network::name(NodeId node) const {
  const auto found = names_.find(node);
  return found == names_.end() ? fmt::format("node {}", node) : found->second;
}

const KnownPdo* Network::pdo(std::uint16_t cob_id) const {
  const auto found = pdos_.find(cob_id);
  return found == pdos_.end() ? nullptr : &found->second;
}

std::optional<std::size_t> Network::drive_of(NodeId node) const {
  for (std::size_t i = 0; i < bus_.drives.size(); ++i) {
    if (bus_.drives[i].node == node) return i;
  }
  return std::nullopt;
}

bool Network::is_gyro(std::uint16_t cob_id) const {
  const KnownPdo* known = pdo(cob_id);
  return known != nullptr && bus_.gyro && known->node == bus_.gyro->node;
}

}  // namespace kenaf::canlog
