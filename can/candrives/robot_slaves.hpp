// All nodes of a robot's bus except its master, and the mechanics behind them: drives, inclinometer, gyro, and one
// plant.
//
// Frames and times in, frames out. Time advances in 1 ms steps of ramps and plant; late calls make up for all missed
// steps, so that the result does not depend on when the calls come. Times never decrease.
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
  // All nodes get power at `start`; the first on_time has their boot-up messages. The plant must outlive this object.
  RobotSlaves(const canbus::RobotBus& bus, Plant& plant, canopen::Time start);

  // A frame of the master or of another node.
  void on_frame(const canopen::Frame& frame, canopen::Time now, Frames& out);
  void on_time(canopen::Time now, Frames& out);
  // Returns when on_time should be called next. A later call loses nothing, but its frames are late.
  canopen::Time deadline() const;

  void inject(const Fault& fault, canopen::Time now, Frames& out);

  std::size_t node_count() const { return nodes_.size(); }
  const Drive& drive(std::size_t index) const { return *drives_[index]; }
  // Returns the node with this id; nullptr if there is none.
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
  canopen::Time next_of_nodes() const;  // the nodes' own next actions, without the plant
  canopen::Time next_event() const;
  canopen::Frame garbage();

  canbus::RobotBus bus_;
  Plant* plant_;
  std::vector<Node> nodes_;  // drives in their order, inclinometer, gyro
  std::vector<Drive*> drives_;
  Inclinometer* inclinometer_ = nullptr;
  Gyro* gyro_ = nullptr;
  PlantCommand command_;
  canopen::Time next_step_;
  std::vector<LateFrame> late_;
  std::optional<canopen::Time> next_garbage_;
  std::mt19937 random_;  // for garbage: the same in every run
};

}  // namespace kenaf::candrives
