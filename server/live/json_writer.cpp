#include "server/live/json_writer.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

namespace kenaf::live {

JsonWriter& JsonWriter::raw(std::string_view text) {
  out_ += text;
  return *this;
}

JsonWriter& JsonWriter::key(std::string_view name) {
  comma();
  out_ += '"';
  out_ += name;
  out_ += "\":";
  return *this;
}

JsonWriter& JsonWriter::comma() {
  if (!out_.empty() && out_.back() != '{' && out_.back() != '[') out_ += ',';
  return *this;
}

JsonWriter& JsonWriter::open(char bracket) {
  out_ += bracket;
  return *this;
}

JsonWriter& JsonWriter::close(char bracket) {
  out_ += bracket;
  return *this;
}

JsonWriter& JsonWriter::number(double value, int digits) {
  if (!std::isfinite(value)) return raw("null");
  fmt::format_to(std::back_inserter(out_), "{:.{}f}", value, digits);
  while (digits > 0 && out_.back() == '0') out_.pop_back();
  if (out_.back() == '.') out_.pop_back();
  return *this;
}

JsonWriter& JsonWriter::integer(std::uint64_t value) {
  fmt::format_to(std::back_inserter(out_), "{}", value);
  return *this;
}

JsonWriter& JsonWriter::text(std::string_view value) {
  using nlohmann::json;
  return raw(json(value).dump(-1, ' ', false, json::error_handler_t::replace));
}

JsonWriter& JsonWriter::numbers(std::span<const double> values, int digits) {
  open('[');
  for (const double value : values) comma().number(value, digits);
  return close(']');
}

JsonWriter& JsonWriter::vector(const Eigen::Vector3d& v) {
  return numbers(std::array{v.x(), v.y(), v.z()});
}

JsonWriter& JsonWriter::rotation(const Eigen::Quaterniond& q) {
  return numbers(std::array{q.w(), q.x(), q.y(), q.z()}, 5);
}

namespace {

void write_belts(JsonWriter& out, std::string_view key, const std::vector<physics::BeltDimensions>& belts) {
  out.key(key).open('[');
  for (const physics::BeltDimensions& belt : belts) {
    out.comma().open('{').key("length").number(belt.length_m).key("radius").number(belt.radius_m);
    out.key("width").number(belt.width_m).key("at").vector(belt.p_B_m).close('}');
  }
  out.close(']');
}

}  // namespace

void write_dimensions(JsonWriter& out, const physics::RobotDimensions& size) {
  out.key("body").vector(size.body_size_m);
  write_belts(out, "tracks", size.tracks);
  write_belts(out, "casters", size.casters);
  out.key("ride_height").number(size.ride_height_m);
  if (size.has_flippers()) {
    out.key("flipper").open('{').key("has").open('[');
    for (const bool has : size.has_flipper) out.comma().boolean(has);
    out.close(']');
    out.key("length").number(size.flipper_length_m).key("width").number(size.flipper_width_m);
    out.key("pivot_radius").number(size.pivot_radius_m).key("tip_radius").number(size.tip_radius_m);
    out.key("at").vector(size.p_BPivot_m);
    out.key("min").number(size.min_angle_rad).key("max").number(size.max_angle_rad);
    out.key("max_speed").number(size.max_flipper_radps).close('}');
  }
  out.key("max_speed").number(size.max_speed_mps);
}

}  // namespace kenaf::live
