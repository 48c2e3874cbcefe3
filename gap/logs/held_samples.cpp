#include "gap/logs/held_samples.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::gap::logs {
namespace {

// All chosen.
constexpr double kManyCounts = 4;     // a change by more counts is no flicker of a sensor at rest
constexpr std::size_t kFewest = 10;   // least number of such changes
constexpr std::size_t kHeldRows = 2;  // nine in ten of them come at least this many rows after the change before
// The median distance is at most this many times the 10 % quantile: a value that changes now and then, as a command, is
// not held.
constexpr std::size_t kRegular = 2;

struct Change {
  std::size_t row;  // among those that have a value
  double t_s, size;
};

std::size_t quantile(const std::vector<std::size_t>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

}  // namespace

std::optional<HeldSamples> held_samples(std::span<const double> t_s, std::span<const double> values) {
  // The repeats, and the changes with their distance from each other.
  HeldSamples held{0, {}};
  std::vector<Change> changes;
  std::size_t rows = 0;
  double last = std::nan("");
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    if (values[i] == last) held.repeats.push_back(i);
    if (rows > 0 && values[i] != last) changes.push_back({rows, t_s[i], std::abs(values[i] - last)});
    last = values[i];
    ++rows;
  }
  if (changes.size() < kFewest || held.repeats.empty()) return std::nullopt;

  // One count is taken as the smallest change in the column; only changes by many counts tell.
  const double count = std::ranges::min(changes, {}, &Change::size).size;
  std::vector<std::size_t> apart;
  std::vector<double> apart_s;
  for (std::size_t i = 1; i < changes.size(); ++i) {
    if (changes[i].size <= kManyCounts * count) continue;
    apart.push_back(changes[i].row - changes[i - 1].row);
    apart_s.push_back(changes[i].t_s - changes[i - 1].t_s);
  }
  if (apart.size() < kFewest) return std::nullopt;

  // Held: the large changes are at least kHeldRows apart, and evenly so.
  std::ranges::sort(apart);
  std::ranges::sort(apart_s);
  const std::size_t least = quantile(apart, 0.1), usual = quantile(apart, 0.5);
  if (least < kHeldRows || usual > kRegular * least) return std::nullopt;
  held.hold_s = apart_s[apart_s.size() / 2];
  return held;
}

}  // namespace kenaf::gap::logs
