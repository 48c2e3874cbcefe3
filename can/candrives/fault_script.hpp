// Faults as text, with their times: `node 3 silent at 5`, `track left fault 0x2310 0.5 after motion for 2`.
//
//   WHO WHAT [at SECONDS | SECONDS after motion] [for SECONDS]
//
//   WHO    node NUMBER, a drive's name ("track left"), inclinometer, gyro, all, bus
//   WHAT   silent, power loss, fault CODE, following error, deaf, sdo abort, sdo late, sdo wrong toggle, short pdos,
//          garbage (of the bus), healed; can/candrives/fault.hpp tells what each does. And quirks of drives' types,
//          each by the words of its name in can/candrives/quirks.hpp: slow boot, node guarding only, position 16 bits,
//          ...
//   at     since the program began; "after motion": since a track turned for the first time; neither: at once
//   for    then it is healed
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "can/canbus/robot_bus.hpp"
#include "can/candrives/fault.hpp"

namespace kenaf::candrives {

struct PlannedFault {
  Fault fault;
  canopen::Time delay{};
  bool after_motion = false;  // otherwise since the program began
  bool at_once = false;       // no time was given
  std::optional<canopen::Time> lasts;
};

// Throws std::invalid_argument saying what is not understood, and what would be.
PlannedFault parse_fault(std::string_view words, const canbus::RobotBus& bus);

// Determines which faults are due.
class FaultScript {
 public:
  explicit FaultScript(canopen::Time start) : start_(start) {}
  void add(const PlannedFault& planned, canopen::Time now);
  void on_motion(canopen::Time now);  // a track turns; the first call counts
  std::vector<Fault> due(canopen::Time now);
  canopen::Time deadline() const;  // of the next fault; Time::max(): none waits for a time

 private:
  struct Entry {
    canopen::Time at;
    PlannedFault planned;
  };
  canopen::Time start_;
  std::optional<canopen::Time> motion_;
  std::vector<Entry> timed_;
  std::vector<PlannedFault> waiting_for_motion_;
};

}  // namespace kenaf::candrives
