#include "physics/files/sdf_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace kenaf::physics {
namespace {

constexpr std::string_view kSdfBlank = " \t\r\n";

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t from = text.find_first_not_of(kSdfBlank);
    if (from == std::string_view::npos) return words;
    text.remove_prefix(from);
    const std::size_t size = std::min(text.find_first_of(kSdfBlank), text.size());
    words.push_back(text.substr(0, size));
    text.remove_prefix(size);
  }
}

std::optional<double> number_from(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  // Below the smallest number it is 0, above the largest it is none.
  if (error == std::errc::result_out_of_range && std::abs(std::strtod(std::string(word).c_str(), nullptr)) < 1)
    return 0;
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

std::vector<double> numbers_of(const SdfElement& element, std::size_t count) {
  const std::vector<std::string_view> words = words_of(element.text);
  std::vector<double> numbers;
  for (const std::string_view word : words) {
    const std::optional<double> number = number_from(word);
    if (!number) fail_at(element, fmt::format("<{}>: \"{}\" is not a number", element.name, word));
    numbers.push_back(*number);
  }
  if (numbers.size() != count)
    fail_at(element,
            fmt::format("<{}> needs {} number{}, not {}", element.name, count, count == 1 ? "" : "s", numbers.size()));
  return numbers;
}

bool truth_from(const SdfElement& element, std::string_view what, std::string_view word) {
  std::string lower(word);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (lower == "true" || lower == "1") return true;
  if (lower == "false" || lower == "0") return false;
  fail_at(element, fmt::format("{} must be true or false, not \"{}\"", what, word));
}

// The child with a text, or null.
const SdfElement* said_in(const SdfElement& element, std::string_view child) {
  const SdfElement* found = child_of(element, child);
  return found && !found->text.empty() ? found : nullptr;
}

// As SDF defines it: fixed axes x, y, z, in this order (http://sdformat.org/tutorials?tut=specify_pose).
Eigen::Quaterniond rotation_of_angles(double roll, double pitch, double yaw) {
  const double cr = std::cos(roll / 2), sr = std::sin(roll / 2);
  const double cp = std::cos(pitch / 2), sp = std::sin(pitch / 2);
  const double cy = std::cos(yaw / 2), sy = std::sin(yaw / 2);
  return {cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
          cr * cp * sy - sr * sp * cy};
}

}  // namespace

double number_in(const SdfElement& element, std::string_view child, double otherwise) {
  const SdfElement* said = said_in(element, child);
  return said ? numbers_of(*said, 1)[0] : otherwise;
}

Eigen::Vector2d vector2_of(const SdfElement& element) {
  const std::vector<double> v = numbers_of(element, 2);
  return {v[0], v[1]};
}

Eigen::Vector3d vector3_in(const SdfElement& element, std::string_view child, const Eigen::Vector3d& otherwise) {
  const SdfElement* said = said_in(element, child);
  if (!said) return otherwise;
  const std::vector<double> v = numbers_of(*said, 3);
  return {v[0], v[1], v[2]};
}

bool truth_in(const SdfElement& element, std::string_view child, bool otherwise) {
  const SdfElement* said = said_in(element, child);
  return said ? truth_from(*said, fmt::format("<{}>", child), said->text) : otherwise;
}

bool truth_attribute_of(const SdfElement& element, std::string_view name, bool otherwise) {
  const std::string_view said = attribute_of(element, name);
  return said.empty() ? otherwise : truth_from(element, name, said);
}

std::string text_in(const SdfElement& element, std::string_view child) {
  const SdfElement* found = child_of(element, child);
  return found ? found->text : "";
}

Pose pose_in(const SdfElement& element) {
  const SdfElement* said = said_in(element, "pose");
  if (!said) return {};
  const std::string_view format = attribute_of(*said, "rotation_format");
  const bool degrees = truth_attribute_of(*said, "degrees", false);
  if (!format.empty() && format != "euler_rpy" && format != "quat_xyzw")
    fail_at(*said, fmt::format("rotation_format must be euler_rpy or quat_xyzw, not \"{}\"", format));

  // Position, then angles or a quaternion.
  const bool has_angles = format != "quat_xyzw";
  if (!has_angles && degrees) fail_at(*said, "degrees must not be true with rotation_format=\"quat_xyzw\"");
  const std::vector<double> v = numbers_of(*said, has_angles ? 6 : 7);
  if (!std::ranges::all_of(v, [](double each) { return std::isfinite(each); }))
    fail_at(*said, "a pose must be finite numbers");
  const double unit = degrees ? std::numbers::pi / 180 : 1;
  const Eigen::Quaterniond q = has_angles ? rotation_of_angles(v[3] * unit, v[4] * unit, v[5] * unit)
                                          : Eigen::Quaterniond(v[6], v[3], v[4], v[5]);
  if (!(q.norm() > 1e-9)) fail_at(*said, "a pose's quaternion must not be zero");
  return {{v[0], v[1], v[2]}, q.normalized()};
}

}  // namespace kenaf::physics
