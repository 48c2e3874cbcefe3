// A motor in the solver of a step: a belt's, or a flipper's servo. It pulls to a speed as far as its limits let it:
//   speed = target - softness * impulse        low <= impulse <= high
// The speed is of one degree of freedom, with the inertia m and the momentum p that it has without motor and contacts:
//   m speed = p + impulse + push of the contacts
// Units: of a belt m/s, N s and kg; of a servo rad/s, N m s and kg m². Thread safety: values and pure functions.
#pragma once

#include "physics/dynamics/bullet.hpp"

namespace kenaf::physics {

struct LimitedDrive {
  double target = 0, low = 0, high = 0;
  double softness = 0;  // speed that it falls short by, for each unit of its impulse in a step; 0: it holds the target
  enum class Limit { none, low, high };
  Limit limit = Limit::none;  // at which it is, from step to step

  bool holds() const { return limit == Limit::none && softness <= 0; }
};

// What a drive that does not hold adds to the two sides of the equation above.
struct YieldingDrive {
  btScalar inertia, momentum;
};
inline YieldingDrive yielding(const LimitedDrive& drive) {
  switch (drive.limit) {
    case LimitedDrive::Limit::low:
      return {0, drive.low};
    case LimitedDrive::Limit::high:
      return {0, drive.high};
    case LimitedDrive::Limit::none:
      break;
  }
  return {1 / drive.softness, drive.target / drive.softness};
}

// `to_hold`: the impulse that keeps the speed at the target, for a drive that holds.
inline btScalar given_impulse(const LimitedDrive& drive, btScalar speed, btScalar to_hold) {
  switch (drive.limit) {
    case LimitedDrive::Limit::low:
      return drive.low;
    case LimitedDrive::Limit::high:
      return drive.high;
    case LimitedDrive::Limit::none:
      break;
  }
  return drive.softness > 0 ? (drive.target - speed) / drive.softness : to_hold;
}

// At which limit it is by the speed that the one assumed has led to: one without a limit may need more than it has; one
// at a limit leaves it where the speed passes the one at which it would give as much without it.
inline LimitedDrive::Limit limit_by(const LimitedDrive& drive, btScalar speed, btScalar to_hold) {
  using Limit = LimitedDrive::Limit;
  constexpr btScalar kPasses = 1e-9;  // beyond rounding
  if (drive.low == drive.high) return Limit::low;
  const auto past = [&](btScalar impulse) { return speed + drive.softness * impulse - drive.target; };
  if (drive.limit == Limit::low) return past(drive.low) < -kPasses ? Limit::none : Limit::low;
  if (drive.limit == Limit::high) return past(drive.high) > kPasses ? Limit::none : Limit::high;
  const btScalar impulse = given_impulse(drive, speed, to_hold);
  return impulse < drive.low ? Limit::low : impulse > drive.high ? Limit::high : Limit::none;
}

// Takes the drive to that limit. Returns whether it was at another one.
inline bool settle(LimitedDrive& drive, btScalar speed, btScalar to_hold) {
  const LimitedDrive::Limit before = drive.limit;
  drive.limit = limit_by(drive, speed, to_hold);
  return drive.limit != before;
}

}  // namespace kenaf::physics
