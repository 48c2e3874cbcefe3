// Reproducible noise: each sensor of each robot has its own generator, seeded by world seed and names.
#pragma once

#include <cstdint>
#include <string_view>

#include <Eigen/Core>

namespace kenaf::physics {

class NoiseSource {
 public:
  NoiseSource(std::uint64_t world_seed, std::string_view robot, std::string_view sensor);

  // Normally distributed, mean 0, standard deviation 1. The standard library's distributions differ between
  // implementations; this one does not.
  double normal();
  double normal(double sigma) { return sigma > 0 ? sigma * normal() : 0; }
  Eigen::Vector3d normal3(double sigma);
  double uniform();  // in (0, 1]

 private:
  std::uint64_t state_;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace kenaf::physics
