#include "can/canbus/bus_layout.hpp"

#include <algorithm>

#include "can/canopen/device.hpp"
#include "can/canopen/drive.hpp"

namespace kenaf::canbus {
namespace {

using canopen::Frame;
using canopen::NodeId;
using canopen::Pdo;
using canopen::PdoDirection;
namespace object = canopen::object;

constexpr std::uint8_t kEachSync = 1, kEachFifthSync = 5;

// CiA 402-2, default PDO mapping, of drives whose mapping is fixed: statusword and position, statusword and velocity;
// controlword and the target of the mode.
DrivePdos default_pdos(bool position_mode) {
  using enum PdoDirection;
  return {.state = {transmit, 3, kEachSync, {object::statusword, object::position_actual}},
          .effort = {transmit, 4, kEachSync, {object::statusword, object::velocity_actual}},
          .battery = {transmit, 2, 10, {}},
          .command = {receive,
                      static_cast<std::uint8_t>(position_mode ? 3 : 4),
                      kEachSync,
                      {object::controlword, position_mode ? object::target_position : object::target_velocity}},
          .has_effort = !position_mode,
          .has_battery = false};
}

Frame frame_of(const Pdo& pdo) {
  Frame frame;
  frame.length = byte_count(pdo);
  return frame;
}

// One kind of frame on the bus and its rate.
struct Traffic {
  Frame frame;
  double per_s;
};

std::vector<Traffic> traffic_of(const RobotBus& bus, double period_s) {
  const double cycles_per_s = 1 / period_s;
  std::vector<Traffic> all{{canopen::kSync, cycles_per_s}};
  const auto add = [&](const Pdo& pdo) { all.push_back({frame_of(pdo), cycles_per_s / pdo.transmission}); };
  for (std::size_t i = 0; i < bus.drives.size(); ++i) {
    const DrivePdos pdos = pdos_of(bus, i);
    add(pdos.state);
    if (pdos.has_effort) add(pdos.effort);
    all.push_back({frame_of(pdos.command), cycles_per_s / bus.drives[i].device.command_every});
    if (pdos.has_battery) add(pdos.battery);
  }
  std::size_t nodes = bus.drives.size();
  if (bus.inclinometer) {
    add(inclinometer_pdo());
    ++nodes;
  }
  if (bus.gyro) {
    // as configured in the device: eight bytes at most, once per SYNC
    all.push_back({{.length = canopen::kMaxFrameBytes}, cycles_per_s});
    ++nodes;
  }
  const Frame heartbeat{.length = 1};
  const auto guarded = static_cast<double>(std::ranges::count_if(
      bus.drives, [](const DriveOnBus& drive) { return drive.device.error_control == ErrorControl::node_guarding; }));
  // a request and its answer in place of the node's own heartbeat
  all.push_back({canopen::guard_request(1), guarded / bus.master_heartbeat_s});
  all.push_back({heartbeat, guarded / bus.master_heartbeat_s});
  all.push_back({heartbeat, 1 / bus.master_heartbeat_s});
  all.push_back({heartbeat, (static_cast<double>(nodes) - guarded) / bus.node_heartbeat_s});
  return all;
}

}  // namespace

DrivePdos pdos_of(const RobotBus& bus, std::size_t drive) {
  using enum PdoDirection;
  const Device& device = bus.drives[drive].device;
  if (device.mapping == Mapping::cia402) return default_pdos(is_position(bus.drives[drive].mode));
  const bool flipper = bus.drives[drive].is_flipper();
  Pdo effort{transmit, 2, flipper ? kEachFifthSync : kEachSync, {}};
  if (!flipper) effort.objects.push_back(object::velocity_actual);
  if (bus.has_currents) effort.objects.push_back(object::current_actual);
  const bool has_effort = !effort.objects.empty();
  return {.state = {transmit, 1, kEachSync, {object::statusword, object::position_actual}},
          .effort = std::move(effort),
          .battery = {transmit, 3, 10, {object::dc_link_voltage}},
          .command = {receive,
                      static_cast<std::uint8_t>(device.command_pdo),
                      kEachSync,
                      {object::controlword,
                       is_position(bus.drives[drive].mode) ? object::target_position : object::target_velocity}},
          .has_effort = has_effort,
          .has_battery = bus.has_battery && drive == 0};
}

Pdo inclinometer_pdo() {
  return {PdoDirection::transmit, 1, kEachSync, {object::slope_longitudinal, object::slope_lateral}};
}

std::vector<std::uint16_t> ids_to_hear(const RobotBus& bus) {
  std::vector<std::uint16_t> ids{canopen::kSyncId, static_cast<std::uint16_t>(canopen::kHeartbeatId + bus.master)};
  const auto add_node = [&ids](NodeId node) {
    for (const std::uint16_t base :
         {canopen::kTransmitPdoId[0], canopen::kTransmitPdoId[1], canopen::kTransmitPdoId[2],
          canopen::kTransmitPdoId[3], canopen::kEmergencyId, canopen::kSdoResponseId, canopen::kHeartbeatId})
      ids.push_back(static_cast<std::uint16_t>(base + node));
  };
  for (const DriveOnBus& drive : bus.drives) add_node(drive.node);
  if (bus.inclinometer) add_node(bus.inclinometer->node);
  if (bus.gyro) add_node(bus.gyro->node);
  return ids;
}

double worst_case_bits_per_s(const RobotBus& bus, double period_s) {
  double bits = 0;
  for (const Traffic& traffic : traffic_of(bus, period_s)) bits += worst_case_bits(traffic.frame) * traffic.per_s;
  for (const OtherOnBus& other : bus.others) bits += other.bits_per_s;
  return bits;
}

double frames_per_s(const RobotBus& bus, double period_s) {
  double frames = 0;
  for (const Traffic& traffic : traffic_of(bus, period_s)) frames += traffic.per_s;
  return frames;
}

}  // namespace kenaf::canbus
