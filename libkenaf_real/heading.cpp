#include "libkenaf_real/heading.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kenaf::real {
namespace {

// A robot still rocks after its tracks have stopped; standing counts only after this time.
constexpr double kSettled_s = 0.2;
// The bias is the mean over the stand at first, and later follows with this time constant.
constexpr double kBiasTime_s = 2;
// A rate above this is a robot turned by hand while its tracks stand, not a bias.
constexpr double kLargestBias_radps = 0.05;
constexpr double kLeastCosine = 0.1;  // on its side or nose a robot has no meaningful heading

double wrapped(double angle_rad) {
  const double turned = std::remainder(angle_rad, 2 * std::numbers::pi);
  return turned <= -std::numbers::pi ? std::numbers::pi : turned;
}

}  // namespace

void Heading::update(double rate_radps, double roll_rad, double pitch_rad, bool standing, double dt_s) {
  standing_s_ = standing ? standing_s_ + dt_s : 0;
  if (standing_s_ > kSettled_s && std::abs(rate_radps) < kLargestBias_radps) {
    learnt_s_ = std::min(learnt_s_ + dt_s, kBiasTime_s);
    bias_radps_ += dt_s / learnt_s_ * (rate_radps - bias_radps_);
  } else if (standing_s_ > kSettled_s) {
    refused_s_ += dt_s;
    last_refused_radps_ = rate_radps;
  }
  const double cosine = std::max(std::cos(pitch_rad), kLeastCosine);
  yaw_rad_ = wrapped(yaw_rad_ + (rate_radps - bias_radps_) * std::cos(roll_rad) / cosine * dt_s);
}

std::optional<double> Heading::unlearnt_radps() const {
  return refused_s_ > learnt_s_ ? std::optional(last_refused_radps_) : std::nullopt;
}

}  // namespace kenaf::real
