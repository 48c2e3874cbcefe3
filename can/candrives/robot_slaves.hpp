// All nodes of a robot's bus, but for its master, and what their motors turn: drives, inclinometer, gyro, and one
// plant.
//
// Frames and times in, frames out. Time runs in steps of 1 ms in which ramps and plant advance; calls that come late
// make up for all steps since, so that what happens does not depend on when the calls come. Times never go back.
#pragma once

#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "can/canbus/robot_bus.hpp"
#include "can/candrives/drive.hpp"
#include "can/candrives/fault.hpp"
#include "can/candrives/gyro.hpp"
#include "can/candrives/inclinometer.hpp"
#include "can/candrives/plant.hpp"

namespace kenaf::candrives {

inline constexpr canopen::Time kStep = std::chrono::milliseconds(1);

class RobotSlaves {
 public:
  // All nodes get power at `start`; the first on_time has their boot-up messages. The plant outlives this object.
  RobotSlaves(const canbus::RobotBus& bus, Plant& plant, canopen::Time start);

  // A frame of the master, or of anybody else.
  void on_frame(const canopen::Frame& frame, canopen::Time now, Frames& out);
  void on_time(canopen::Time now, Frames& out);
  // When on_time should be called next. A later call loses nothing, but its frames are late.
  canopen::Time deadline() const;

  void inject(const Fault& fault, canopen::Time now, Frames& out);

  std::size_t node_count() const { return nodes_.size(); }
  const Drive& drive(std::size_t index) const { return *drives_[index]; }
  // Of a node that there is; nullptr: none has this id.
  const Slave* slave(canopen::NodeId node) const;

 private:
  struct Node {
    std::unique_ptr<Slave> slave;
    NodeFaults faults;
    std::optional<canopen::Time> power_on_at;  // without power until then
  };
  struct LateFrame {
    canopen::Time at;
    canopen::Frame frame;
  };
  void advance(canopen::Time now, Frames& out);
  void step();
  void measure();
  void serve(Node& node, canopen::Time now, Frames& out);
  void pass_on(const Node& node, const Frames& from_node, canopen::Time now, Frames& out);
  void inject(const Fault& fault, Node& node, canopen::Time now);
  Drive* as_drive(const Node& node) const;
  canopen::Time next_of_nodes() const;  // what they have to do by themselves; the plant aside
  canopen::Time next_event() const;
  canopen::Frame garbage();

  canbus::RobotBus bus_;
  Plant* plant_;
  std::vector<Node> nodes_;  // drives in their order, inclinometer, gyro
  std::array<Drive*, canbus::kDriveCount> drives_{};
  Inclinometer* inclinometer_ = nullptr;
  Gyro* gyro_ = nullptr;
  PlantCommand command_;
  canopen::Time next_step_;
  std::vector<LateFrame> late_;
  std::optional<canopen::Time> next_garbage_;
  std::mt19937 random_;  // of the garbage: the same in every run
};

}  // namespace kenaf::candrives
