// The minimum of a function of one number, by golden section (Kiefer 1953, Proceedings of the AMS 4, 502).
//
// Thread safety: a pure function, if `function` is.
#pragma once

#include <array>
#include <cstddef>
#include <numbers>

namespace kenaf::gap::diagnose {

struct Minimum {
  double at, value;
};

// N searches side by side, each from `low` to `high`, for functions that cost less together:
// `function(std::array<double, N>)` returns the array of their values, each at its own place. Returns for each the
// location of its minimum and its value: the better of the last two evaluations. `sections`: evaluations after the
// first two, each of which reduces the interval to 0.618. Finds a local minimum if there are several.
template <std::size_t N, class Functions>
std::array<Minimum, N> golden_sections(double low, double high, int sections, Functions&& functions) {
  constexpr double kPart = std::numbers::phi - 1;
  struct Bracket {
    double low, high, a, b;
    bool left;  // the minimum is on the left of b
  };
  const double a = high - kPart * (high - low), b = low + kPart * (high - low);
  std::array<Bracket, N> bracket;
  bracket.fill({low, high, a, b, false});
  std::array<double, N> place;
  place.fill(a);
  std::array<double, N> at_a = functions(place);
  place.fill(b);
  std::array<double, N> at_b = functions(place);
  for (int i = 0; i < sections; ++i) {
    for (std::size_t k = 0; k < N; ++k) {
      Bracket& of = bracket[k];
      of.left = at_a[k] < at_b[k];
      if (of.left) {
        of.high = of.b, of.b = of.a, at_b[k] = at_a[k];
        place[k] = of.a = of.high - kPart * (of.high - of.low);
      } else {
        of.low = of.a, of.a = of.b, at_a[k] = at_b[k];
        place[k] = of.b = of.low + kPart * (of.high - of.low);
      }
    }
    const std::array<double, N> value = functions(place);
    for (std::size_t k = 0; k < N; ++k) (bracket[k].left ? at_a : at_b)[k] = value[k];
  }
  std::array<Minimum, N> minima;
  for (std::size_t k = 0; k < N; ++k)
    minima[k] = at_a[k] < at_b[k] ? Minimum{bracket[k].a, at_a[k]} : Minimum{bracket[k].b, at_b[k]};
  return minima;
}

// One search.
template <class Function>
Minimum golden_section(double low, double high, int sections, Function&& function) {
  return golden_sections<1>(low, high, sections,
                            [&](const std::array<double, 1>& at) { return std::array<double, 1>{function(at[0])}; })[0];
}

}  // namespace kenaf::gap::diagnose
