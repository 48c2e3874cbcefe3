#include "server/world_server/scan_angles.hpp"

#include <cmath>

namespace kenaf::world_server {

ScanAngles scan_angles(const physics::SensorDescription& scanner, protocol::usarsim::NumberFormat format) {
  constexpr int kMostDecimals = 9;
  const ScanAngles exact{scanner.resolution_rad, scanner.field_of_view_rad, format};
  const double steps = static_cast<double>(scanner.scan_values()) - 1;
  if (!format.truncate || steps < 1) return exact;
  // In units of the last digit: the field of view is cut, the resolution is the greatest number below one step of it,
  // so that rounding of the client's quotient does not matter.
  for (int decimals = format.decimals; decimals <= kMostDecimals; ++decimals) {
    const double units = std::pow(10, decimals);
    const double field_of_view = std::floor(scanner.field_of_view_rad * units + 1e-6);
    const double resolution = std::ceil(field_of_view / steps) - 1;
    if (field_of_view < (steps + 1) * resolution) return {resolution / units, field_of_view / units, {decimals, true}};
  }
  return exact;
}

}  // namespace kenaf::world_server
