#include "tools/describe/mirror_images.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "formats/description/description_error.hpp"

namespace kenaf::describe {

double MirrorImages::compared(double left, double right, double most, const std::string& difference) {
  constexpr double kRounded = 1e-6;  // not worth a word
  const double apart = std::abs(left - right);
  if (!(apart <= most))
    differences_.push_back(difference);
  else if (apart > kRounded)
    small_.push_back(difference);
  return (left + right) / 2;
}

double MirrorImages::length_m(const char* what, double left, double right) {
  return compared(
      left, right, tolerance_m_,
      fmt::format("{} by {:.3g} mm ({:.5g} and {:.5g} m)", what, std::abs(left - right) * 1000, left, right));
}

double MirrorImages::angle_rad(const char* what, double left, double right) {
  return compared(left, right, 2 * tolerance_m_,
                  fmt::format("{} by {:.3g} rad ({:.5g} and {:.5g} rad)", what, std::abs(left - right), left, right));
}

double MirrorImages::mass_kg(const char* what, double left, double right) {
  return compared(left, right, 20 * tolerance_m_ * (left + right) / 2,
                  fmt::format("{} by {:.3g} kg ({:.5g} and {:.5g} kg)", what, std::abs(left - right), left, right));
}

void MirrorImages::check(std::vector<std::string>& warnings) const {
  if (!differences_.empty())
    throw description::DescriptionError(
        fmt::format("{}: \"{}\" and \"{}\" are no mirror images of each other, as a description has them: they differ "
                    "in {}; --tolerance allows more",
                    file_, left_, right_, fmt::join(differences_, ", ")));
  if (!small_.empty())
    warnings.push_back(
        fmt::format("\"{}\" and \"{}\" differ in {}; the mean counts", left_, right_, fmt::join(small_, ", ")));
}

}  // namespace kenaf::describe
