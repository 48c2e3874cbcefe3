// An electronic data sheet (EDS, DCF) in words, and what of it contradicts what the library does with such a drive.
#pragma once

#include <string>
#include <vector>

#include "can/canbus/robot_bus.hpp"
#include "can/canopen/eds_file.hpp"

namespace kenaf::canlog {

// One line for each object: type, access, mappable or not, limits, value. Numbers with $NODEID are those of `node`, or
// say so for node 0.
std::string to_text(const canopen::EdsFile& file, canopen::NodeId node);

struct EdsFinding {
  canopen::ObjectAddress object;
  int line;  // of the object's section; 0: it has none
  std::string words;
};

// Compares the file with all that is read and written by SDO for this drive (canbus::all_steps_of_drive) and with the
// objects in its PDOs: objects that are missing, cannot be written, read or mapped, have another size, or whose limits
// exclude the value. Objects that the library does without are not missed, but of a drive's two watches for its master
// one must be there. Each finding once, in the library's order.
std::vector<EdsFinding> check_eds(const canopen::EdsFile& file, const canbus::RobotBus& bus, std::size_t drive,
                                  double period_s);

}  // namespace kenaf::canlog
