#include "can/candrives/robot_slaves.hpp"

#include <algorithm>

#include "can/candrives/motor_border.hpp"

namespace kenaf::candrives {

using canopen::Frame;
using canopen::NodeId;
using canopen::Time;

namespace {

// Largest lag of the plant while a motor turns and nobody sends. Less would wake up every millisecond; more would delay
// the answer to a SYNC, before which all time since the last one would have to be simulated.
constexpr Time kMaxBehind = std::chrono::milliseconds(2);

}  // namespace

RobotSlaves::RobotSlaves(const canbus::RobotBus& bus, Plant& plant, Time start)
    : bus_(bus), plant_(&plant), next_step_(start + kStep) {
  const PlantState& state = plant.state();
  for (std::size_t i = 0; i < bus_.drives.size(); ++i) {
    auto drive = std::make_unique<Drive>(drive_setup(bus_, i), candrives::measure(bus_, i, state));
    drives_.push_back(drive.get());
    nodes_.push_back({std::move(drive), {}, start});
  }
  if (bus_.inclinometer) {
    auto inclinometer = std::make_unique<Inclinometer>(*bus_.inclinometer);
    inclinometer_ = inclinometer.get();
    nodes_.push_back({std::move(inclinometer), {}, start});
  }
  if (bus_.gyro) {
    auto gyro = std::make_unique<Gyro>(*bus_.gyro);
    gyro_ = gyro.get();
    nodes_.push_back({std::move(gyro), {}, start});
  }
  command_.flipper_rad = state.flipper_rad;
  measure();
}

const Slave* RobotSlaves::slave(NodeId node) const {
  const auto found = std::ranges::find(nodes_, node, [](const Node& one) { return one.slave->node(); });
  return found == nodes_.end() ? nullptr : found->slave.get();
}

// ---- time ----

void RobotSlaves::on_frame(const Frame& frame, Time now, Frames& out) {
  advance(now, out);
  for (Node& node : nodes_) {
    if (node.power_on_at || node.faults.silent) continue;
    Frames from_node;
    node.slave->on_frame(frame, now, from_node);
    pass_on(node, from_node, now, out);
  }
}

void RobotSlaves::on_time(Time now, Frames& out) {
  advance(now, out);
}

// In order of time: steps of the plant, and the nodes' own actions.
void RobotSlaves::advance(Time now, Frames& out) {
  for (Time next = next_event(); next <= now; next = next_event()) {
    if (next == next_step_) {
      step();
      next_step_ += kStep;
    }
    for (Node& node : nodes_) serve(node, next, out);
    std::erase_if(late_, [&](const LateFrame& late) {
      if (late.at <= next) out.push_back(late.frame);
      return late.at <= next;
    });
    if (next_garbage_ && next >= *next_garbage_) {
      out.push_back(garbage());
      next_garbage_ = next + kStep;
    }
  }
}

Time RobotSlaves::next_of_nodes() const {
  Time next = next_garbage_.value_or(Time::max());
  for (const LateFrame& late : late_) next = std::min(next, late.at);
  for (const Node& node : nodes_) next = std::min(next, node.power_on_at.value_or(node.slave->deadline()));
  return next;
}

Time RobotSlaves::next_event() const {
  return std::min(next_step_, next_of_nodes());
}

Time RobotSlaves::deadline() const {
  const bool is_watched =
      std::ranges::any_of(nodes_, [](const Node& node) { return !node.power_on_at && node.slave->follows_data(); });
  const bool moves = std::ranges::any_of(drives_, [](const Drive* drive) { return drive->is_powered(); });
  const Time step = is_watched ? next_step_ : moves ? next_step_ - kStep + kMaxBehind : Time::max();
  return std::min(step, next_of_nodes());
}

void RobotSlaves::step() {
  command_.track_mps = {};
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    Drive& drive = *drives_[i];
    if (!nodes_[i].power_on_at) drive.step(kStep);
    add_command(bus_, i, drive, candrives::measure(bus_, i, plant_->state()), command_);
  }
  plant_->advance(kStep, command_);
  measure();
}

void RobotSlaves::measure() {
  const PlantState& state = plant_->state();
  for (std::size_t i = 0; i < drives_.size(); ++i) drives_[i]->measure(candrives::measure(bus_, i, state));
  if (inclinometer_ != nullptr) inclinometer_->measure(state.roll_rad, state.pitch_rad);
  if (gyro_ != nullptr) gyro_->measure(state.yaw_rate_radps);
}

void RobotSlaves::serve(Node& node, Time now, Frames& out) {
  Frames from_node;
  if (node.power_on_at) {
    if (now < *node.power_on_at) return;
    node.power_on_at.reset();
    node.slave->power_on(now, from_node);
  } else {
    node.slave->on_time(now, from_node);
  }
  pass_on(node, from_node, now, out);
}

// ---- faults ----

void RobotSlaves::pass_on(const Node& node, const Frames& from_node, Time now, Frames& out) {
  if (node.faults.silent) return;
  for (const Frame& frame : from_node) {
    const Frame on_bus = altered(frame, node.slave->node(), node.faults);
    if (node.faults.sdo_late && is_sdo_answer(frame, node.slave->node()))
      late_.push_back({now + kLateBy, on_bus});
    else
      out.push_back(on_bus);
  }
}

Drive* RobotSlaves::as_drive(const Node& node) const {
  const auto found = std::ranges::find(drives_, node.slave.get(), [](Drive* drive) -> Slave* { return drive; });
  return found == drives_.end() ? nullptr : *found;
}

void RobotSlaves::inject(const Fault& fault, Time now, Frames& out) {
  advance(now, out);
  if (fault.kind == FaultKind::garbage) next_garbage_ = now + kStep;
  if (fault.kind == FaultKind::healed && fault.node == 0) next_garbage_.reset();
  for (Node& node : nodes_) {
    if (fault.node != 0 && fault.node != node.slave->node()) continue;
    inject(fault, node, now);
    serve(node, now, out);
  }
}

void RobotSlaves::inject(const Fault& fault, Node& node, Time now) {
  // Quirks go to the node; drive faults to the drive; frame faults set flags for serve() and pass_on(); garbage belongs
  // to the bus.
  Drive* drive = as_drive(node);
  Quirks quirks = node.slave->quirks();
  if (switch_on(quirks, fault.kind)) return node.slave->set_quirks(quirks);
  switch (fault.kind) {
    case FaultKind::silent:
      node.faults.silent = true;
      return;
    case FaultKind::power_loss:
      node.power_on_at = now + kPowerGap;
      if (drive != nullptr) drive->cut_power();
      return;
    case FaultKind::error:
      if (drive != nullptr) drive->fail(fault.error_code);
      return;
    case FaultKind::following_error:
      if (drive != nullptr) drive->fail(canopen::kErrorFollowing);
      return;
    case FaultKind::deaf:
      if (drive != nullptr) drive->set_deaf(true);
      return;
    case FaultKind::no_heartbeat:
      return node.slave->ignore_heartbeat(true);
    case FaultKind::no_event_timer:
      return node.slave->ignore_event_timer(true);
    case FaultKind::sdo_abort:
      node.faults.sdo_abort = true;
      return;
    case FaultKind::sdo_late:
      node.faults.sdo_late = true;
      return;
    case FaultKind::sdo_wrong_toggle:
      node.faults.sdo_wrong_toggle = true;
      return;
    case FaultKind::short_pdos:
      node.faults.short_pdos = true;
      return;
    case FaultKind::sdo_garbage:
      node.faults.sdo_garbage = true;
      return;
    case FaultKind::healed:
      node.faults = {};
      node.slave->ignore_heartbeat(false);
      node.slave->ignore_event_timer(false);
      node.slave->set_quirks({});
      if (drive != nullptr) drive->set_deaf(false);
      return;
    default:
      return;
  }
}

// Random identifier, length and data.
Frame RobotSlaves::garbage() {
  Frame frame{.id = static_cast<std::uint16_t>(random_() & 0x7ff), .length = static_cast<std::uint8_t>(random_() % 9)};
  for (std::size_t i = 0; i < frame.length; ++i) frame.data[i] = static_cast<std::uint8_t>(random_());
  return frame;
}

}  // namespace kenaf::candrives
