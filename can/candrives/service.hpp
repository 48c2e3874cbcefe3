// Serves a robot's nodes on a bus in real time: frames as they arrive, faults as they fall due, and events on the
// terminal.
//
// One thread. It sleeps until a frame arrives or a node has something to do; only then the plant is brought up to date,
// which saves a wake-up for each of its steps. A bus that goes down may come up again, and the nodes continue
// meanwhile, as real ones do.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "can/candrives/fault_script.hpp"
#include "can/candrives/robot_slaves.hpp"
#include "can/canopen/bus.hpp"

namespace kenaf::candrives {

using OpenBus = std::function<std::unique_ptr<canopen::Bus>()>;  // throws BusError

class Service {
 public:
  // `where`: "vcan0: robot kenaf in world flat", for the line reporting that all nodes are up.
  Service(const canbus::RobotBus& bus, Plant& plant, std::string where);

  void plan(const PlannedFault& fault);
  // Runs until `stop`. Lines on standard input are faults. Throws BusError if the bus is not available at the start.
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
  canopen::Time start_, now_;  // time up to which the nodes have been served
  RobotSlaves slaves_;
  FaultScript faults_;
  std::vector<canopen::PowerState> reported_;
  std::string input_;  // incomplete line
  bool input_open_ = true, said_slow_ = false;
  canopen::Time spent_{}, simulated_{};
};

}  // namespace kenaf::candrives
