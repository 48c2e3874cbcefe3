#include "can/candrives/inclinometer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "can/canopen/device.hpp"

namespace kenaf::candrives {

using canopen::PdoDirection;

namespace {

constexpr std::int64_t kHundredthDegree = 10;  // object 0x6000: thousandths of a degree
// Device type, bits 16 to 23: two axes with 16 and 32 bits.
constexpr std::uint32_t kTwoAxes = 0x00020000 | canopen::kProfileInclinometer;
constexpr std::uint16_t kInhibit100us = 100;  // 10 ms: a slope changes continually

std::vector<DefaultPdo> pdos() {
  return {
      {{PdoDirection::transmit, 1, 254, {canopen::object::slope_longitudinal, canopen::object::slope_lateral}},
       true,
       kInhibit100us,
       0},
      {{PdoDirection::transmit, 2, 254, {canopen::object::slope_longitudinal_32, canopen::object::slope_lateral_32}},
       false,
       kInhibit100us,
       0}};
}

// Inverse of the equation of canbus::InclinometerAxis, angle = direction * slope - zero.
double slope_of(const canbus::InclinometerAxis& axis, double angle_rad) {
  return axis.direction * (angle_rad + axis.zero_rad);
}

}  // namespace

Inclinometer::Inclinometer(const canbus::InclinometerOnBus& setup)
    : Slave(setup.node,
            {.device_type = kTwoAxes,
             .name = "Kenaf simulated inclinometer",
             .product_code = canopen::kProfileInclinometer,
             .revision = 1,
             .serial_number = setup.node},
            pdos()),
      setup_(setup) {
  dictionary().add(canopen::object::slope_resolution, Access::read_write, Mappable::no, kHundredthDegree);
  for (const auto& slope : {canopen::object::slope_longitudinal, canopen::object::slope_lateral,
                            canopen::object::slope_longitudinal_32, canopen::object::slope_lateral_32})
    dictionary().add(slope, Access::read_only, Mappable::transmit, 0);
}

void Inclinometer::measure(double roll_rad, double pitch_rad) {
  (setup_.roll.lateral ? lateral_rad_ : longitudinal_rad_) = slope_of(setup_.roll, roll_rad);
  (setup_.pitch.lateral ? lateral_rad_ : longitudinal_rad_) = slope_of(setup_.pitch, pitch_rad);
}

// A slope out of range of its number saturates.
void Inclinometer::refresh() {
  const double units_per_rad =
      180 / std::numbers::pi * 1000 / static_cast<double>(objects().value(canopen::object::slope_resolution.object));
  const auto put = [&](const canopen::MappedObject& at, double slope_rad) {
    const ObjectLimits range = range_of(at.type);
    dictionary().set(at.object, std::llround(std::clamp(slope_rad * units_per_rad, static_cast<double>(range.min),
                                                        static_cast<double>(range.max))));
  };
  put(canopen::object::slope_longitudinal, longitudinal_rad_);
  put(canopen::object::slope_lateral, lateral_rad_);
  put(canopen::object::slope_longitudinal_32, longitudinal_rad_);
  put(canopen::object::slope_lateral_32, lateral_rad_);
}

std::optional<canopen::SdoAbort> Inclinometer::check_write(canopen::ObjectAddress at, std::int64_t value) {
  const bool is_resolution = value == 1 || value == 10 || value == 100 || value == 1000;
  if (at == canopen::object::slope_resolution.object && !is_resolution) return canopen::SdoAbort::invalid_value;
  return std::nullopt;
}

}  // namespace kenaf::candrives
