#include "tools/draw/noise.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace kenaf::draw {

namespace {

constexpr std::size_t kFewest = 8;    // values that tell their noise
constexpr double kOfNormal = 1.4826;  // standard deviation over the median of absolute values, normal distribution
constexpr double kOfThirdDifferences = 20;  // their variance, over that of white noise: 1 + 9 + 9 + 1

}  // namespace

double noise_of(std::span<const double> values) {
  std::vector<double> v;
  std::ranges::unique_copy(values, std::back_inserter(v));
  if (v.size() < kFewest) return 0;
  std::vector<double> thirds;
  for (std::size_t i = 3; i < v.size(); ++i) thirds.push_back(std::abs(v[i] - 3 * v[i - 1] + 3 * v[i - 2] - v[i - 3]));
  const auto middle = thirds.begin() + static_cast<std::ptrdiff_t>(thirds.size() / 2);
  std::ranges::nth_element(thirds, middle);
  return kOfNormal * *middle / std::sqrt(kOfThirdDifferences);
}

}  // namespace kenaf::draw
