// Two parts that must be mirror images of each other, and the mean of both.
//
// Thread safety: a value belongs to one thread.
#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace kenaf::describe {

// Compares numbers of two links, one after the other.
class MirrorImages {
 public:
  MirrorImages(std::string file, std::string left, std::string right, double tolerance_m)
      : file_(std::move(file)), left_(std::move(left)), right_(std::move(right)), tolerance_m_(tolerance_m) {}

  // Return the mean of both.
  double length_m(const char* what, double left, double right);
  double angle_rad(const char* what, double left, double right);
  double mass_kg(const char* what, double left, double right);

  // Throws DescriptionError with all that differ, and by how much, if one differs by more than the tolerance, which for
  // each mm is 2 mrad of an angle and 2 % of a mass. Smaller differences go to `warnings`.
  void check(std::vector<std::string>& warnings) const;

 private:
  double compared(double left, double right, double most, const std::string& difference);

  std::string file_, left_, right_;
  double tolerance_m_;
  std::vector<std::string> differences_, small_;
};

}  // namespace kenaf::describe
