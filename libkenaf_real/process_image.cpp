#include "libkenaf_real/process_image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace kenaf::real {
namespace {

using canopen::Frame;
using canopen::NmtState;
using canopen::ReceivedFrame;
using canopen::Time;
namespace object = canopen::object;

// A position is impossible if it changes by more than twice the full speed allows, in the time between two frames with
// this much jitter, and this far (m or rad) beyond. Chosen: the nearest counter that wraps, 16 bits, is far beyond.
constexpr double kJitter_s = 0.02, kPlay = 0.02;
// Chosen: neither noise nor a filter's delay lasts as long above this share of the full speed.
constexpr int kContradictions = 20;
constexpr double kMoves = 0.05;

// The number that the lower `bits` mean in two's complement.
std::int64_t signed_of(std::int64_t raw, int bits) {
  const std::int64_t span = std::int64_t{1} << bits, low = raw & (span - 1);
  return low >= span / 2 ? low - span : low;
}

std::vector<canbus::DrivePdos> pdos_of_all(const canbus::RobotBus& bus) {
  std::vector<canbus::DrivePdos> out;
  for (std::size_t i = 0; i < bus.drives.size(); ++i) out.push_back(canbus::pdos_of(bus, i));
  return out;
}

}  // namespace

ProcessImage::ProcessImage(const canbus::RobotBus& bus)
    : bus_(bus), pdos_(pdos_of_all(bus)), drives_(bus.drives.size()), motions_(bus.drives.size()) {}

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
  // Returns false if the frame is not this PDO, whole.
  const auto take = [&](const canopen::Pdo& pdo) {
    if (frame.id != cob_id(pdo, node) || !unpack(pdo, frame, std::span(values).first(pdo.objects.size()))) return false;
    for (std::size_t k = 0; k < pdo.objects.size(); ++k) on_value(i, pdo.objects[k], values[k], received.at);
    return true;
  };
  if (take(pdos_[i].state)) {
    drive.state_at = received.at;
  } else if (pdos_[i].has_effort && take(pdos_[i].effort)) {
    drive.effort_at = received.at;
  } else if (pdos_[i].has_battery && take(pdos_[i].battery)) {
    return;
  } else if (const auto emergency = canopen::emergency_from(frame); emergency && emergency->node == node) {
    drive.emergency = emergency->error_code == canopen::kErrorNone ? std::nullopt : emergency;
  } else if (const auto heartbeat = canopen::heartbeat_from(frame); heartbeat && heartbeat->node == node) {
    if (heartbeat->state == NmtState::boot_up) drive.restarted = true;
  }
}

void ProcessImage::on_value(std::size_t i, const canopen::MappedObject& mapped, std::int64_t value, Time at) {
  DriveInput& drive = drives_[i];
  if (mapped.object == object::statusword.object)
    drive.statusword = static_cast<std::uint16_t>(value);
  else if (mapped.object == object::position_actual.object)
    on_position(i, value, at);
  else if (mapped.object == object::velocity_actual.object)
    on_velocity(i, value);
  else if (mapped.object == object::current_actual.object)
    drive.current_permil = static_cast<std::int16_t>(value);
  else if (mapped.object == object::dc_link_voltage.object) {
    battery_v_ = 1e-3 * static_cast<double>(value);
    battery_at_ = at;
  }
}

void ProcessImage::on_position(std::size_t i, std::int64_t raw, Time at) {
  const canbus::DriveOnBus& on_bus = bus_.drives[i];
  const int bits = on_bus.device.position_bits;
  DriveInput& drive = drives_[i];
  Motion& motion = motions_[i];
  const std::int64_t change = signed_of(raw - std::exchange(motion.raw_position, raw), bits);
  const double counts_per_unit = std::abs(on_bus.units.counts_per_unit);

  if (is_position(on_bus.mode) && bits < 32) {
    // the only angle within the range, or beside it, that the counter can mean
    const double middle =
        on_bus.units.zero_counts + (on_bus.min_position + on_bus.max_position) / 2 * on_bus.units.counts_per_unit;
    const std::int64_t centre = std::llround(middle);
    drive.position = static_cast<std::int32_t>(centre + signed_of(raw - centre, bits));
  } else if (!drive.state_at) {
    drive.position = static_cast<std::int32_t>(raw);
  } else {
    drive.position = static_cast<std::int32_t>(static_cast<std::uint32_t>(drive.position) +
                                               static_cast<std::uint32_t>(static_cast<std::int32_t>(change)));
  }
  if (!drive.state_at) return;

  const double elapsed_s = std::chrono::duration<double>(at - *drive.state_at).count();
  if (change != 0) motion.direction = change > 0 ? 1 : -1;
  motion.change_per_s = elapsed_s > 0 ? static_cast<double>(change) / elapsed_s : 0;
  const double farthest = counts_per_unit * (2 * on_bus.max_speed * (elapsed_s + kJitter_s) + kPlay);
  if (watches_jumps_ && std::abs(static_cast<double>(change)) > farthest && drive.jump == 0)
    drive.jump = static_cast<std::int32_t>(change);
}

// A drive whose velocity runs against its position for kContradictions cycles gives it in another form than its device
// file says; the position is right, since it was driven by.
void ProcessImage::on_velocity(std::size_t i, std::int64_t raw) {
  const canbus::DriveOnBus& on_bus = bus_.drives[i];
  const canbus::DriveUnits& units = on_bus.units;
  DriveInput& drive = drives_[i];
  Motion& motion = motions_[i];
  std::int64_t velocity = raw;
  if (on_bus.device.velocity == canbus::VelocitySign::low_16_bits) velocity = signed_of(raw, 16);
  if (on_bus.device.velocity == canbus::VelocitySign::magnitude) velocity = motion.direction * std::abs(raw);

  const double by_position = motion.change_per_s * units.velocity_per_unit / units.counts_per_unit;
  const double moves = kMoves * on_bus.max_speed * std::abs(units.velocity_per_unit);
  const bool contradicts = static_cast<double>(velocity) * by_position < 0 &&
                           std::abs(static_cast<double>(velocity)) > moves && std::abs(by_position) > moves;
  motion.contradictions = contradicts ? motion.contradictions + 1 : 0;
  if (motion.contradictions >= kContradictions) drive.velocity_doubted = true;
  if (drive.velocity_doubted) velocity = std::llround(by_position);
  drive.velocity = static_cast<std::int32_t>(std::clamp<std::int64_t>(
      velocity, std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max()));
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
