// Serves a robot's nodes on a bus in real time: frames as they come, faults as they are due, and on the terminal what
// happens.
//
// One thread. It sleeps until a frame comes or a node has something to do by itself; the plant is brought up to date
// then, so that nothing has to wake up for each of its steps. A bus that goes down comes up again some time, and the
// nodes live on meanwhile, as real ones do.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "can/candrives/fault_script.hpp"
#include "can/candrives/robot_slaves.hpp"
#include "can/canopen/bus.hpp"

namespace kenaf::candrives {

using OpenBus = std::function<std::unique_ptr<canopen::Bus>()>;  // throws BusError

class Service {
 public:
  // `where`: "vcan0: robot kenaf in world flat", for the line that says that all nodes are up.
  Service(const canbus::RobotBus& bus, Plant& plant, std::string where);

  void plan(const PlannedFault& fault);
  // Until `stop`. Lines on standard input are faults. Throws BusError if the bus cannot be had at the start.
  void run(const OpenBus& open, const std::atomic<bool>& stop);

 private:
  void serve(canopen::Bus& bus, const std::atomic<bool>& stop);
  void live_without_bus();
  void up_to(canopen::Time now, const canopen::Frame* frame, Frames& out);
  void inject_due(Frames& out);
  void read_input();
  void report_states();
  void watch_speed(canopen::Time before, canopen::Time began);

  canbus::RobotBus bus_;
  Plant* plant_;
  std::string where_;
  canopen::Time start_, now_;  // up to when the nodes have been served
  RobotSlaves slaves_;
  FaultScript faults_;
  std::array<canopen::PowerState, canbus::kDriveCount> reported_{};
  std::string input_;  // of a line that is not whole yet
  bool input_open_ = true, said_slow_ = false;
  canopen::Time spent_{}, simulated_{};
};

}  // namespace kenaf::candrives
