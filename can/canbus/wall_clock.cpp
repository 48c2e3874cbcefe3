#include "can/canbus/wall_clock.hpp"

namespace kenaf::canbus {
namespace {

using canopen::Time;

constexpr Time kOldest = std::chrono::seconds(1);
// More than the drift of the clocks between two frames, and less than would make a drive seem silent.
constexpr Time kStep = std::chrono::milliseconds(5);

}  // namespace

Time received_at(WallClock& clock, Time stamp, Time wall_now, Time now) {
  const Time ahead = wall_now - now, age = wall_now - stamp;
  if (clock.ahead && std::chrono::abs(ahead - *clock.ahead) > kStep) clock.set_at = now;
  clock.ahead = ahead;
  const bool is_age = age >= Time(0) && age < kOldest && (!clock.set_at || now - age >= *clock.set_at);
  return is_age ? now - age : now;
}

}  // namespace kenaf::canbus
