#include "physics/noise.hpp"

#include <cmath>
#include <numbers>

namespace kenaf::physics {
namespace {

// FNV-1a, http://www.isthe.com/chongo/tech/comp/fnv/; the zero byte ends a name
std::uint64_t hash(std::uint64_t seed, std::string_view text) {
  for (const char c : text) seed = (seed ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return seed * 0x100000001b3u;
}

}  // namespace

NoiseSource::NoiseSource(std::uint64_t world_seed, std::string_view robot, std::string_view sensor)
    : state_(hash(hash(0xcbf29ce484222325u ^ world_seed, robot), sensor)) {}

double NoiseSource::uniform() {
  // splitmix64, https://prng.di.unimi.it/splitmix64.c
  std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  return (static_cast<double>(z >> 11) + 1) * 0x1.0p-53;
}

double NoiseSource::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  // Box and Muller 1958
  const double radius = std::sqrt(-2 * std::log(uniform()));
  const double angle = 2 * std::numbers::pi * uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

Eigen::Vector3d NoiseSource::normal3(double sigma) {
  const double x = normal(sigma), y = normal(sigma), z = normal(sigma);  // in this order
  return {x, y, z};
}

}  // namespace kenaf::physics
