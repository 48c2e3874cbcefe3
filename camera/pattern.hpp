// The texture of all surfaces, already averaged over what a pixel sees of it, so that it does not flicker far away.
//
// Along each of the two texture coordinates the same pattern of period 1 is laid: a square wave (+1, then -1), which
// the material multiplies with the other coordinate's into checks, and lines at each tenth. Both are kept averaged over
// footprints from 1/512 to 2 periods, four to an octave, and fade out before a footprint is half a period, where they
// would beat with the pixels.
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
  };  // wave: -127 to 127; line: 0 to 127, the share that lines cover

  Pattern();
  Value at(int level, int phase) const { return values_[static_cast<std::size_t>(level * kPhases + phase)]; }

 private:
  std::vector<Value> values_;
};

}  // namespace kenaf::camera
