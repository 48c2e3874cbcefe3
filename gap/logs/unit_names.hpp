// Which unit a column probably has, from the factor by which it is too large.
//
// Thread safety: pure functions.
#pragma once

#include <optional>
#include <string>

namespace kenaf::gap::logs {

enum class Measure {
  belt_speed,   // column in m/s, surface speed of a track
  belt_travel,  // m, travel of a track
  place,        // m
  angle,        // rad
  turn_rate,    // rad/s
};

struct UnitName {
  std::string words;  // "km/h: divide by 3.6"
  bool is_known;      // false: only that it would fit, as any radius of a sprocket does
};

// Returns the unit of which `factor` says that a column is so many times too large. `tolerance` is the largest relative
// difference from a unit's factor, at least 0.02. `sprocket_radius_m`: of the robot's tracks; empty: any from 0.02 to
// 0.5 m may be. Empty if nothing fits.
std::optional<UnitName> unit_name(Measure measure, double factor, double tolerance,
                                  std::optional<double> sprocket_radius_m);

}  // namespace kenaf::gap::logs
