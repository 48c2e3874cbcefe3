// Random numbers that are the same for a seed with every standard library; std distributions are not.
//
// Thread safety: each function modifies only its engine.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace kenaf::gap {

using Random = std::mt19937_64;

inline double uniform(Random& random, double from, double to) {
  return from + (to - from) * (static_cast<double>(random() >> 11) * 0x1p-53);
}
inline std::size_t below(Random& random, std::size_t count) {
  return static_cast<std::size_t>(uniform(random, 0, static_cast<double>(count)));
}
inline double log_uniform(Random& random, double from, double to) {
  return std::exp(uniform(random, std::log(from), std::log(to)));
}
template <class T>
void shuffle(std::vector<T>& values, Random& random) {
  for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[below(random, i)]);
}

// Derives a separate seed for each value of `with`.
inline std::uint64_t mixed(std::uint64_t seed, std::uint64_t with) {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                         static_cast<std::uint32_t>(with)};
  std::uint32_t words[2];
  sequence.generate(words, words + 2);
  return std::uint64_t{words[0]} << 32 | words[1];
}

}  // namespace kenaf::gap
