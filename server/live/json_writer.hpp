// Writes JSON for a page: compact, as a tenth of a millimetre is enough to look at, and a library would write 17
// digits. What is not finite becomes null. Thread safety: none; one thread owns a JsonWriter.
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
  // Of an object's member; its value follows.
  JsonWriter& key(std::string_view name);
  // Before an element of a list or an object; not needed before a key.
  JsonWriter& comma();
  JsonWriter& open(char bracket);
  JsonWriter& close(char bracket);

  // At most `digits` behind the point.
  JsonWriter& number(double value, int digits = 4);
  JsonWriter& integer(std::uint64_t value);
  JsonWriter& boolean(bool value) { return raw(value ? "true" : "false"); }
  JsonWriter& text(std::string_view value);  // bytes that are no UTF-8 are replaced
  JsonWriter& numbers(std::span<const double> values, int digits = 4);
  JsonWriter& vector(const Eigen::Vector3d& v);
  JsonWriter& rotation(const Eigen::Quaterniond& q);  // w, x, y, z
  std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

// The members of an object by which a page draws a robot: "body", "track", "flipper", "max_speed" (docs/live-view.md).
void write_dimensions(JsonWriter& out, const physics::RobotDimensions& size);

}  // namespace kenaf::live
