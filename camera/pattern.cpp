#include "camera/pattern.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::camera {

namespace {

constexpr double kLinePeriod = 0.1, kLineWidth = 0.008;

// The integral of the wave from 0 to x.
double wave_integral(double x) {
  const double part = x - std::floor(x);
  return part < 0.5 ? part : 1 - part;
}

// The integral from 0 to x of a function that is 1 within half a line's width of each line, else 0.
double line_integral(double x) {
  const double count = std::floor(x / kLinePeriod), part = x - count * kLinePeriod;
  return count * kLineWidth + std::min(part, kLineWidth / 2) + std::max(0.0, part - (kLinePeriod - kLineWidth / 2));
}

// The contrast that remains of a pattern for a footprint of so many of its periods.
double kept(double periods) {
  return std::clamp((0.6 - periods) / 0.35, 0.0, 1.0);
}

}  // namespace

Pattern::Pattern() : values_(static_cast<std::size_t>(kLevels) * kPhases) {
  // The mean over a footprint is the difference of integrals over its width; faded towards the pattern's mean.
  for (int level = 0; level < kLevels; ++level) {
    const double width = std::exp2(kSmallest + (level + 0.5) / 4);
    for (int phase = 0; phase < kPhases; ++phase) {
      const double from = (phase + 0.5) / kPhases - width / 2, to = from + width;
      const double wave = kept(width) * (wave_integral(to) - wave_integral(from)) / width;
      const double mean = kLineWidth / kLinePeriod;
      const double line = mean + kept(width / kLinePeriod) * ((line_integral(to) - line_integral(from)) / width - mean);
      values_[static_cast<std::size_t>(level * kPhases + phase)] = {static_cast<std::int8_t>(std::lround(127 * wave)),
                                                                    static_cast<std::int8_t>(std::lround(127 * line))};
    }
  }
}

}  // namespace kenaf::camera
