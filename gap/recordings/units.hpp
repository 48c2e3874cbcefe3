// Units in which other programs log, and their factors to the units of a run's columns.
//
// Thread safety: pure functions.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace kenaf::gap::recordings {

// By how much a number in `unit` is to be multiplied to be in `column_unit`, one of robot/columns.hpp: 1e-3 for "mm" to
// "m". Speeds and travel of tracks may also be in turns of the sprocket ("rad/s", "rpm", "rad", "turn", ...), if
// `radius_m` is given. Empty if there is no such unit, or the radius is missing.
std::optional<double> unit_factor(std::string_view column_unit, std::string_view unit, std::optional<double> radius_m);

// The units that unit_factor() knows for `column_unit`, for an error: "m, mm, cm, ...".
std::string units_for(std::string_view column_unit);

// Whether `unit` counts turns of the sprocket for a column of `column_unit`, so that unit_factor() needs its radius.
bool needs_radius(std::string_view column_unit, std::string_view unit);

}  // namespace kenaf::gap::recordings
