#include "gap/logs/unit_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace kenaf::gap::logs {
namespace {

constexpr double kLeastTolerance = 0.02;                          // chosen
constexpr double kLeastSprocket_m = 0.02, kMostSprocket_m = 0.5;  // chosen

struct Unit {
  const char* words;
  double factor;  // numbers in this unit for one in SI
};

constexpr Unit kSpeedUnits[] = {{"km/h", 3.6},           {"ft/s", 1 / 0.3048}, {"mph", 1 / 0.44704},
                                {"knots", 1 / 0.514444}, {"dm/s", 10},         {"cm/s", 100},
                                {"mm/s", 1000},          {"in/s", 1 / 0.0254}, {"m/min", 60}};
constexpr Unit kLengthUnits[] = {
    {"decimetres", 10}, {"centimetres", 100}, {"millimetres", 1000}, {"feet", 1 / 0.3048}, {"inches", 1 / 0.0254}};
constexpr Unit kAngleUnits[] = {{"degrees", 180 / std::numbers::pi}, {"turns", 0.5 / std::numbers::pi}};
constexpr Unit kRateUnits[] = {{"degrees per second", 180 / std::numbers::pi},
                               {"rpm", 30 / std::numbers::pi},
                               {"turns per second", 0.5 / std::numbers::pi}};
// Of a sprocket: numbers in this unit for one radian, or radian per second.
constexpr Unit kSprocketSpeeds[] = {{"rad/s", 1},
                                    {"rpm", 30 / std::numbers::pi},
                                    {"deg/s", 180 / std::numbers::pi},
                                    {"turns/s", 0.5 / std::numbers::pi}};
constexpr Unit kSprocketTravels[] = {{"rad", 1}, {"deg", 180 / std::numbers::pi}, {"turns", 0.5 / std::numbers::pi}};

std::span<const Unit> units_of(Measure measure) {
  switch (measure) {
    case Measure::belt_speed:
      return kSpeedUnits;
    case Measure::belt_travel:
    case Measure::place:
      return kLengthUnits;
    case Measure::angle:
      return kAngleUnits;
    case Measure::turn_rate:
      return kRateUnits;
  }
  return {};
}

std::span<const Unit> of_sprocket(Measure measure) {
  if (measure == Measure::belt_speed) return kSprocketSpeeds;
  if (measure == Measure::belt_travel) return kSprocketTravels;
  return {};
}

}  // namespace

std::optional<UnitName> unit_name(Measure measure, double factor, double tolerance,
                                  std::optional<double> sprocket_radius_m) {
  const double most = std::log1p(std::max(tolerance, kLeastTolerance));
  const auto distance = [factor](double of_unit) { return std::abs(std::log(factor / of_unit)); };

  // The nearest of the units that are known; of an angle's sprocket the robot's radius makes a unit.
  std::optional<UnitName> nearest;
  double least = most;
  const auto offer = [&](double of_unit, const std::string& words) {
    if (distance(of_unit) > least) return;
    least = distance(of_unit);
    nearest = {words, true};
  };
  for (const Unit& unit : units_of(measure)) {
    offer(unit.factor, fmt::format("{}: divide by {:.5g}", unit.words, unit.factor));
    offer(1 / unit.factor,
          fmt::format("a conversion from {} that was made twice: multiply by {:.5g}", unit.words, unit.factor));
  }
  if (sprocket_radius_m)
    for (const Unit& unit : of_sprocket(measure))
      offer(unit.factor / *sprocket_radius_m,
            fmt::format("{} of the sprocket, whose radius is {:.3g} m: multiply by {:.4g}", unit.words,
                        *sprocket_radius_m, *sprocket_radius_m / unit.factor));
  if (nearest) return nearest;

  // A sprocket of another radius.
  for (const Unit& unit : of_sprocket(measure).first(std::min<std::size_t>(1, of_sprocket(measure).size())))
    if (const double radius_m = unit.factor / factor; radius_m >= kLeastSprocket_m && radius_m <= kMostSprocket_m)
      return UnitName{
          fmt::format("{} of a sprocket with a radius of {:.3g} m: multiply by its radius", unit.words, radius_m),
          false};
  return std::nullopt;
}

}  // namespace kenaf::gap::logs
