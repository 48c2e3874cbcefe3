// What is on a robot's bus in its description: any text gives a bus whose nodes differ and whose numbers the drives can
// hold, or an error with a place.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "can/canbus/robot_bus.hpp"
#include "formats/description/description_error.hpp"

using namespace kenaf;

namespace {

void check(bool fine) {
  if (!fine) std::abort();
}

// There and back: at most half a count lies between.
void check_position(const canbus::DriveUnits& units, double position) {
  const double back = canbus::position_from_drive(units, canbus::position_to_drive(units, position));
  check(std::abs(back - position) * std::abs(units.counts_per_unit) <= 0.51);
}

void check_drive(const canbus::DriveOnBus& drive, bool track) {
  check(drive.node >= 1 && drive.node <= canopen::kMaxNode);
  check(canbus::velocity_to_drive(drive.units, drive.max_speed) != 0);
  check(canbus::acceleration_to_drive(drive.units, drive.acceleration) >= 1);
  check(canbus::acceleration_to_drive(drive.units, drive.quick_stop_deceleration) >= 1);
  if (track) return;
  check_position(drive.units, drive.min_position);
  check_position(drive.units, drive.max_position);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const canbus::RobotBus bus = canbus::parse_robot_bus({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
    check(!bus.interface.empty() && canbus::longest_stop_s(bus) <= bus.stop_within_s && bus.stop_within_s <= 2);
    std::array<bool, canopen::kMaxNode + 1> taken{};
    taken[bus.master] = true;
    std::set<std::string> names;
    for (const canbus::DriveOnBus& drive : bus.drives) {
      check_drive(drive, !drive.is_flipper());
      check(drive.drives_of_side == static_cast<std::size_t>(std::ranges::count_if(bus.drives, [&](const auto& other) {
              return drive.is_flipper() ? &other == &drive : !other.is_flipper() && other.side == drive.side;
            })));
      check(!std::exchange(taken[drive.node], true) && names.insert(drive.name).second);
    }
    if (bus.gyro) check(bus.gyro->first_bit + bus.gyro->bits <= 64 && !std::exchange(taken[bus.gyro->node], true));
  } catch (const description::DescriptionError& error) {
    check(std::string_view(error.what()).starts_with("fuzz.toml"));
  }
  return 0;
}
