// The texture of all surfaces, averaged in advance over a pixel's footprint, so that it does not flicker far away.
//
// Both texture coordinates have the same pattern of period 1: a square wave (+1, then -1), whose product with that of
// the other coordinate makes checks, and lines at each tenth. Both are stored averaged over footprints from 1/512 to 2
// periods, four to an octave, and fade out before a footprint reaches half a period, where they would alias.
//
// Thread safety: a value.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace kenaf::camera {

class Pattern {
 public:
  static constexpr int kPhases = 512;
  static constexpr int kLevels = 41;    // of footprints
  static constexpr int kSmallest = -9;  // log2 of level 0's footprint

  struct Value {
    std::int8_t wave, line;
  };  // wave: -127 to 127; line: 0 to 127, share covered by lines

  Pattern();
  Value at(int level, int phase) const { return values_[static_cast<std::size_t>(level * kPhases + phase)]; }

 private:
  std::vector<Value> values_;
};

}  // namespace kenaf::camera
