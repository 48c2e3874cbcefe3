// Exports of motion capture. For table_forms.cpp.
//
// Thread safety: pure functions.
#pragma once

#include <span>
#include <string>

#include "gap/recordings/table_forms.hpp"

namespace kenaf::gap::recordings {

// Motive (docs.optitrack.com, Data Export: CSV): line 1 has pairs of key and value, and above the line that begins with
// "Frame" are lines of type, name, ID and quantity. Rigid bodies are read; its y axis points up by default.
bool is_motive(std::span<const std::string> lines);
TableForm motive_form(std::span<const std::string> lines);

// Vicon Nexus and Tracker: the section's name, frames per second, bodies, columns, units. RX, RY, RZ are axis times
// angle, or with RW a quaternion.
bool is_vicon(std::span<const std::string> lines);
TableForm vicon_form(std::span<const std::string> lines);

// Qualisys, TSV of 6DOF data: keys, then a line of columns, for each body X to Rot[8]. Roll, pitch and yaw are applied
// in this order, each about the axis as turned by those before (docs.qualisys.com, Rotation angles in QTM).
bool is_qualisys(std::span<const std::string> lines);
TableForm qualisys_form(std::span<const std::string> lines);

// Each throws RecordingError with what is missing.

}  // namespace kenaf::gap::recordings
