#include "gap/recordings/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace kenaf::gap::recordings {
namespace {

constexpr double kPi = std::numbers::pi, kTurn = 2 * kPi, kDegree = kPi / 180;
constexpr double kStandardGravity_mps2 = 9.80665, kFoot_m = 0.3048, kMile_m = 1609.344;

struct Unit {
  std::string_view column_unit, name;
  double factor;
  bool by_radius = false;  // of a belt: times the sprocket's radius
};

constexpr Unit kUnits[] = {
    {"m/s", "m/s", 1},
    {"m/s", "mm/s", 1e-3},
    {"m/s", "cm/s", 1e-2},
    {"m/s", "km/h", 1 / 3.6},
    {"m/s", "mph", kMile_m / 3600},
    {"m/s", "ft/s", kFoot_m},
    {"m/s", "rad/s", 1, true},
    {"m/s", "deg/s", kDegree, true},
    {"m/s", "rpm", kTurn / 60, true},
    {"m/s", "turn/s", kTurn, true},
    {"m", "m", 1},
    {"m", "mm", 1e-3},
    {"m", "cm", 1e-2},
    {"m", "ft", kFoot_m},
    {"m", "in", kFoot_m / 12},
    {"m", "rad", 1, true},
    {"m", "deg", kDegree, true},
    {"m", "turn", kTurn, true},
    {"rad", "rad", 1},
    {"rad", "deg", kDegree},
    {"rad", "turn", kTurn},
    {"rad/s", "rad/s", 1},
    {"rad/s", "deg/s", kDegree},
    {"rad/s", "rpm", kTurn / 60},
    {"rad/s", "turn/s", kTurn},
    {"m/s^2", "m/s^2", 1},
    {"m/s^2", "g", kStandardGravity_mps2},
    {"m/s^2", "mg", 1e-3 * kStandardGravity_mps2},
    {"A", "A", 1},
    {"A", "mA", 1e-3},
    {"V", "V", 1},
    {"V", "mV", 1e-3},
};

const Unit* unit_named(std::string_view column_unit, std::string_view name) {
  const auto* found = std::ranges::find_if(
      kUnits, [&](const Unit& unit) { return unit.column_unit == column_unit && unit.name == name; });
  return found == std::end(kUnits) ? nullptr : found;
}

}  // namespace

std::optional<double> unit_factor(std::string_view column_unit, std::string_view unit, std::optional<double> radius_m) {
  const Unit* found = unit_named(column_unit, unit);
  if (found == nullptr) return column_unit == unit ? std::optional(1.0) : std::nullopt;
  if (!found->by_radius) return found->factor;
  return radius_m ? std::optional(found->factor * *radius_m) : std::nullopt;
}

std::string units_for(std::string_view column_unit) {
  std::string names;
  for (const Unit& unit : kUnits)
    if (unit.column_unit == column_unit) names += (names.empty() ? "" : ", ") + std::string(unit.name);
  return names.empty() ? std::string(column_unit) : names;
}

bool needs_radius(std::string_view column_unit, std::string_view unit) {
  const Unit* found = unit_named(column_unit, unit);
  return found != nullptr && found->by_radius;
}

}  // namespace kenaf::gap::recordings
