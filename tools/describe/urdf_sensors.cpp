#include "tools/describe/urdf_sensors.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tools/describe/urdf_text.hpp"
#include "tools/describe/xml_tree.hpp"

namespace kenaf::describe {
namespace {

using physics::CameraDescription;
using physics::Pose;
using physics::SensorDescription;
using physics::SensorType;
using std::numbers::pi;

// Encoders and the like are the drives', and have no place.
bool has_place(SensorType type) {
  return type != SensorType::encoder && type != SensorType::odometry && type != SensorType::tachometer &&
         type != SensorType::drives;
}

std::string unused(std::string name, std::set<std::string>& names) {
  while (!names.insert(name).second) name += "_sensor";
  return name;
}

std::string scan_of(const SensorDescription& sensor) {
  const double half_rad = sensor.field_of_view_rad / 2;
  return fmt::format(
      "<ray><scan><horizontal><samples>{:.0f}</samples><min_angle>{}</min_angle><max_angle>{}</max_angle></"
      "horizontal></scan>"
      "<range><min>{}</min><max>{}</max></range></ray>",
      std::round(sensor.field_of_view_rad / sensor.resolution_rad) + 1, -half_rad, half_rad, sensor.min_range_m,
      sensor.max_range_m);
}

// SDF has a cone by its radius at the end.
std::string cone_of(const SensorDescription& sensor) {
  return fmt::format("<sonar><min>{}</min><max>{}</max><radius>{}</radius></sonar>", sensor.min_range_m,
                     sensor.max_range_m, sensor.max_range_m * std::tan(sensor.field_of_view_rad / 2));
}

// SDF's type and what it takes; empty: Gazebo has none.
std::pair<std::string, std::string> for_gazebo(const SensorDescription& sensor) {
  switch (sensor.type) {
    case SensorType::imu:
      return {"imu", ""};
    case SensorType::gps:
      return {"gps", ""};
    case SensorType::touch:
      return {"contact", ""};
    case SensorType::range_scanner:
      return {"ray", scan_of(sensor)};
    case SensorType::sonar:
      if (sensor.field_of_view_rad < pi) return {"sonar", cone_of(sensor)};
      return {};
    default:
      return {};
  }
}

std::string gazebo_sensor(const std::string& link, const std::string& name, const std::string& type, double rate_hz,
                          const std::string& more) {
  const std::string rate = rate_hz > 0 ? fmt::format("<update_rate>{}</update_rate>", rate_hz) : "";
  return fmt::format("  <gazebo reference=\"{}\"><sensor name=\"{}\" type=\"{}\">{}{}</sensor></gazebo>\n",
                     xml_escaped(link), xml_escaped(name), type, rate, more);
}

std::string camera_frame(const physics::RobotDescription& robot, const CameraDescription& camera,
                         std::set<std::string>& names) {
  const Pose& X_BC = camera.mission_package ? robot.mission_packages[*camera.mission_package].X_BM : camera.X_BC;
  const std::string link = unused(camera.name, names), optical = unused(link + "_optical", names);
  const std::string picture = fmt::format(
      "<camera><horizontal_fov>{}</horizontal_fov><image><width>{}</width><height>{}</height></image></camera>",
      camera.field_of_view_rad, camera.width, camera.height);
  return link_text(link, {}, {}, "") + fixed_joint("base_link", link, X_BC) + link_text(optical, {}, {}, "") +
         fixed_joint(link, optical, {{0, 0, 0}, physics::rotation_from({-pi / 2, 0, -pi / 2})}) +
         gazebo_sensor(link, camera.name, "camera", camera.rate_hz, picture);
}

}  // namespace

std::string sensor_frames(const physics::RobotDescription& robot, std::set<std::string>& names) {
  std::string text;
  for (const SensorDescription& sensor : robot.sensors) {
    if (!has_place(sensor.type)) continue;
    const std::string link = unused(sensor.name, names);
    text += link_text(link, {}, {}, "") + fixed_joint("base_link", link, sensor.X_BS);
    if (const auto [type, more] = for_gazebo(sensor); !type.empty())
      text += gazebo_sensor(link, sensor.name, type, sensor.period_s > 0 ? 1 / sensor.period_s : 0, more);
  }
  for (const CameraDescription& camera : robot.cameras) text += camera_frame(robot, camera, names);
  return text;
}

}  // namespace kenaf::describe
