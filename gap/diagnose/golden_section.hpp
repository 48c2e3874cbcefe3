// The minimum of a function of one number, by golden section (Kiefer 1953, Proceedings of the AMS 4, 502).
//
// Thread safety: a pure function, if `function` is.
#pragma once

#include <numbers>
#include <utility>

namespace kenaf::gap::diagnose {

// Returns the location of the minimum of `function` in [low, high] and its value: the better of the last two
// evaluations. `sections`: evaluations after the first two, each of which reduces the interval to 0.618. Finds a local
// minimum if there are several.
template <class Function>
std::pair<double, double> golden_section(double low, double high, int sections, Function&& function) {
  constexpr double kPart = std::numbers::phi - 1;
  double a = high - kPart * (high - low), b = low + kPart * (high - low);
  double at_a = function(a), at_b = function(b);
  for (int i = 0; i < sections; ++i) {
    if (at_a < at_b) {
      high = b, b = a, at_b = at_a;
      a = high - kPart * (high - low), at_a = function(a);
    } else {
      low = a, a = b, at_a = at_b;
      b = low + kPart * (high - low), at_b = function(b);
    }
  }
  return at_a < at_b ? std::pair{a, at_a} : std::pair{b, at_b};
}

}  // namespace kenaf::gap::diagnose
