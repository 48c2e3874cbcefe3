#include "gap/datasets/physics_settings.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <stdexcept>

namespace kenaf::gap::datasets {
namespace {

constexpr std::string_view kKeys = "time_step_s, solver_iterations, contact_stiffness_npm, contact_damping_nspm";

}  // namespace

void set_physics(physics::PhysicsSettings& settings, std::string_view assignment) {
  const std::size_t equals = assignment.find('=');
  const std::string_view key = assignment.substr(0, equals);
  const std::string_view number = equals == assignment.npos ? "" : assignment.substr(equals + 1);
  // Parses the number and checks its range.
  const auto value_in = [&](double min, double max) {
    double value = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (error != std::errc{} || end != number.data() + number.size())
      throw std::invalid_argument(fmt::format("physics {}: \"{}\" is not a number; write {}=VALUE", key, number, key));
    if (!(value >= min && value <= max))
      throw std::invalid_argument(
          fmt::format("physics {}: {} is out of range; it goes from {} to {}", key, value, min, max));
    return value;
  };
  if (key == "time_step_s") {
    settings.time_step_s = value_in(1e-5, 0.01);
  } else if (key == "solver_iterations") {
    const double count = value_in(1, 1000);
    if (count != std::floor(count))
      throw std::invalid_argument(fmt::format("physics {}: {} is not a whole number", key, count));
    settings.solver_iterations = static_cast<int>(count);
  } else if (key == "contact_stiffness_npm") {
    settings.contact_stiffness_npm = value_in(1e3, 1e8);
  } else if (key == "contact_damping_nspm") {
    settings.contact_damping_nspm = value_in(0, 1e6);
  } else {
    throw std::invalid_argument(fmt::format("physics \"{}\": write KEY=VALUE with one of {}", assignment, kKeys));
  }
}

std::string physics_text(const physics::PhysicsSettings& settings) {
  return fmt::format("time_step_s={} solver_iterations={} contact_stiffness_npm={} contact_damping_nspm={}",
                     settings.time_step_s, settings.solver_iterations, settings.contact_stiffness_npm,
                     settings.contact_damping_nspm);
}

}  // namespace kenaf::gap::datasets
