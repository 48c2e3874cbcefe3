#include "libkenaf_real/process_image.hpp"

namespace kenaf::real {
namespace {

using canopen::Frame;
using canopen::NmtState;
using canopen::ReceivedFrame;
using canopen::Time;

std::vector<canbus::DrivePdos> pdos_of_all(const canbus::RobotBus& bus) {
  std::vector<canbus::DrivePdos> out;
  for (std::size_t i = 0; i < bus.drives.size(); ++i) out.push_back(canbus::pdos_of(bus, i));
  return out;
}

}  // namespace

ProcessImage::ProcessImage(const canbus::RobotBus& bus)
    : bus_(bus), pdos_(pdos_of_all(bus)), drives_(bus.drives.size()) {}

void ProcessImage::watch_restarts() {
  for (DriveInput& drive : drives_) drive.restarted = false;
}

void ProcessImage::on_frame(const ReceivedFrame& received) {
  if (is_sync(received.frame)) {
    sync_at_ = received.at;
    return;
  }
  for (std::size_t i = 0; i < drives_.size(); ++i) on_drive_frame(i, received);
  on_sensor_frame(received);
}

void ProcessImage::on_drive_frame(std::size_t i, const ReceivedFrame& received) {
  const Frame& frame = received.frame;
  const canopen::NodeId node = bus_.drives[i].node;
  DriveInput& drive = drives_[i];
  std::array<std::int64_t, 2> values{};
  if (frame.id == cob_id(pdos_[i].state, node)) {
    if (!unpack(pdos_[i].state, frame, values)) return;
    drive.statusword = static_cast<std::uint16_t>(values[0]);
    drive.position = static_cast<std::int32_t>(values[1]);
    drive.state_at = received.at;
  } else if (pdos_[i].has_effort && frame.id == cob_id(pdos_[i].effort, node)) {
    const std::size_t count = pdos_[i].effort.objects.size();
    if (!unpack(pdos_[i].effort, frame, std::span(values).first(count))) return;
    if (!bus_.drives[i].is_flipper()) drive.velocity = static_cast<std::int32_t>(values[0]);
    if (bus_.has_currents) drive.current_permil = static_cast<std::int16_t>(values[count - 1]);
    drive.effort_at = received.at;
  } else if (pdos_[i].has_battery && frame.id == cob_id(pdos_[i].battery, node)) {
    if (unpack(pdos_[i].battery, frame, std::span(values).first(1))) battery_v_ = 1e-3 * static_cast<double>(values[0]);
  } else if (const auto emergency = canopen::emergency_from(frame); emergency && emergency->node == node) {
    drive.emergency = emergency->error_code == canopen::kErrorNone ? std::nullopt : emergency;
  } else if (const auto heartbeat = canopen::heartbeat_from(frame); heartbeat && heartbeat->node == node) {
    if (heartbeat->state == NmtState::boot_up) drive.restarted = true;
  }
}

void ProcessImage::on_sensor_frame(const ReceivedFrame& received) {
  const Frame& frame = received.frame;
  if (bus_.inclinometer && frame.id == cob_id(slope_pdo_, bus_.inclinometer->node)) {
    std::array<std::int64_t, 2> values{};
    if (!unpack(slope_pdo_, frame, values)) return;
    slope_ = {static_cast<std::int16_t>(values[0]), static_cast<std::int16_t>(values[1]), received.at};
  } else if (bus_.gyro && frame.id == canopen::kTransmitPdoId[bus_.gyro->pdo - 1] + bus_.gyro->node) {
    if (const auto rate = bits_of(frame, bus_.gyro->first_bit, bus_.gyro->bits)) gyro_ = {*rate, received.at};
  }
}

bool ProcessImage::is_complete() const {
  if (!sync_at_) return false;
  const auto is_new = [this](const std::optional<Time>& at) { return at && *at >= *sync_at_; };
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (!is_new(drives_[i].state_at) || (!bus_.drives[i].is_flipper() && !is_new(drives_[i].effort_at))) return false;
  }
  return (!bus_.inclinometer || is_new(slope_.at)) && (!bus_.gyro || is_new(gyro_.at));
}

}  // namespace kenaf::real
