// Writes JSON for a page: compact, since a tenth of a millimetre suffices for display, while a library would write 17
// digits. Non-finite numbers become null. Thread safety: none; one thread owns a JsonWriter.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "physics/robot_dimensions.hpp"

namespace kenaf::live {

class JsonWriter {
 public:
  JsonWriter& raw(std::string_view text);
  // The key of an object's member; its value follows.
  JsonWriter& key(std::string_view name);
  // Needed before an element of a list or an object, but not before a key.
  JsonWriter& comma();
  JsonWriter& open(char bracket);
  JsonWriter& close(char bracket);

  // At most `digits` decimals.
  JsonWriter& number(double value, int digits = 4);
  JsonWriter& integer(std::uint64_t value);
  JsonWriter& boolean(bool value) { return raw(value ? "true" : "false"); }
  JsonWriter& text(std::string_view value);  // invalid UTF-8 is replaced
  JsonWriter& numbers(std::span<const double> values, int digits = 4);
  JsonWriter& vector(const Eigen::Vector3d& v);
  JsonWriter& rotation(const Eigen::Quaterniond& q);  // w, x, y, z
  std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

// Writes the members from which a page draws a robot: "body", "tracks", "casters", "ride_height", "flipper",
// "max_speed" (docs/live-view.md).
void write_dimensions(JsonWriter& out, const physics::RobotDimensions& size);

}  // namespace kenaf::live
