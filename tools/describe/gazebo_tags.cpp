#include "tools/describe/gazebo_tags.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace kenaf::describe {
namespace {

using physics::Pose;
using std::numbers::pi;

constexpr std::size_t kMostSensors = 50, kMostCameras = 8;  // of a description, less those that every robot has

std::vector<double> numbers_below(const XmlNode& node, std::string_view path) {
  const XmlNode* const found = node.below(path);
  if (!found) return {};
  const std::string* const value = found->attribute("value");
  return numbers_in(value ? *value : found->text).value_or(std::vector<double>());
}

std::optional<double> number_below(const XmlNode& node, std::string_view path) {
  const std::vector<double> numbers = numbers_below(node, path);
  return numbers.size() == 1 ? std::optional(numbers.front()) : std::nullopt;
}

const Link* link_named(const UrdfModel& model, const XmlNode& gazebo) {
  const std::string* const reference = gazebo.attribute("reference");
  if (gazebo.name != "gazebo" || !reference) return nullptr;
  const auto found = std::ranges::find(model.links, *reference, &Link::name);
  return found == model.links.end() ? nullptr : &*found;
}

std::vector<const XmlNode*> gazebo_of(const UrdfModel& model, const std::string& link) {
  std::vector<const XmlNode*> nodes;
  for (const XmlNode& node : model.document.children) {
    const std::string* const reference = node.attribute("reference");
    if (node.name == "gazebo" && reference && *reference == link) nodes.push_back(&node);
  }
  return nodes;
}

double in_range(double mu, const std::string& link, std::vector<std::string>& warnings) {
  const double limited = std::clamp(mu, 0.0, 10.0);
  if (limited != mu) warnings.push_back(fmt::format("link \"{}\": friction of {} becomes {}", link, mu, limited));
  return limited;
}

bool fdir1_is_across(const Link& link, const XmlNode& gazebo) {
  const std::vector<double> fdir1 = numbers_below(gazebo, "fdir1");
  if (fdir1.size() != 3) return false;
  const Pose X_FS = link.shapes.empty() ? link.X_FL : compose(link.X_FL, link.shapes.front().X_LS);
  const Eigen::Vector3d d = X_FS.q * Eigen::Vector3d(fdir1[0], fdir1[1], fdir1[2]);
  return std::abs(d.y()) > std::hypot(d.x(), d.z());
}

// A unique name without blanks or braces.
std::string sensor_name(const XmlNode& sensor, const std::string& link, std::set<std::string>& taken) {
  const std::string* const given = sensor.attribute("name");
  std::string name = comment_text(given && !given->empty() ? *given : link);
  std::ranges::replace_if(
      name, [](char c) { return c == ' ' || c == '{' || c == '}'; }, '_');
  std::string unique = name;
  for (int n = 2; !taken.insert(unique).second; ++n) unique = fmt::format("{}_{}", name, n);
  return unique;
}

Pose mount_of(const Link& link, const XmlNode& sensor, const Pose& X_FB) {
  Pose X_LS;
  const std::vector<double> pose = numbers_below(sensor, "pose");
  if (pose.size() == 6) X_LS = {{pose[0], pose[1], pose[2]}, physics::rotation_from({pose[3], pose[4], pose[5]})};
  return compose(inverse(X_FB), compose(link.X_FL, X_LS));
}

void add_mount(Table& table, const Pose& X_BS) {
  table.from_urdf("mount_m", toml_vector(X_BS.p));
  if (const Eigen::Vector3d rpy = physics::roll_pitch_yaw(X_BS.q); rpy.norm() > 1e-9)
    table.from_urdf("mount_rpy_rad", toml_vector(rpy));
}

void add_period(Table& table, const XmlNode& sensor) {
  const auto rate_hz = number_below(sensor, "update_rate");
  if (rate_hz && *rate_hz >= 1.0 / 3600) table.from_urdf("period_s", toml_number(1 / *rate_hz));
}

Table table_of_sensor(const std::string& type, const std::string& name, const Pose& X_BS, const XmlNode& sensor) {
  Table table{.name = "sensor", .one_of_several = true, .entries = {}};
  table.from_urdf("type", toml_text(type));
  table.from_urdf("name", toml_text(name));
  add_mount(table, X_BS);
  add_period(table, sensor);
  return table;
}

// A number of the file if it lies in a range, else a chosen one.
void add_number(Table& table, const char* key, std::optional<double> found, double least, double most,
                double otherwise) {
  if (found && *found >= least && *found <= most)
    table.from_urdf(key, toml_number(*found));
  else
    table.chosen(key, toml_number(otherwise));
}

void add_range(Table& table, std::optional<double> min_m, std::optional<double> max_m) {
  const bool said = min_m && max_m && *min_m >= 0 && *max_m > *min_m;
  add_number(table, "min_range_m", said ? min_m : std::nullopt, 0, 1e6, 0.02);
  add_number(table, "max_range_m", said ? max_m : std::nullopt, 0, 1e6, 20);
}

// A planar scan; its middle is the sensor's x axis.
void add_scan(Table& table, const XmlNode& ray, Pose X_BS) {
  const double from = number_below(ray, "scan/horizontal/min_angle").value_or(-pi / 2);
  const double to = number_below(ray, "scan/horizontal/max_angle").value_or(pi / 2);
  const double field_rad = std::clamp(to - from, 0.0, 2 * pi);
  if (const double middle = (from + to) / 2; std::abs(middle) > 1e-9 && std::abs(middle) <= 2 * pi) {
    X_BS.q = X_BS.q * physics::rotation_from({0, 0, middle});
    std::erase_if(table.entries, [](const Entry& e) { return e.key.starts_with("mount_"); });
    add_mount(table, X_BS);
  }
  add_range(table, number_below(ray, "range/min"), number_below(ray, "range/max"));
  table.from_urdf("field_of_view_rad", toml_number(field_rad));
  const auto samples = number_below(ray, "scan/horizontal/samples");
  if (samples && *samples >= 2 && *samples <= 4096 && field_rad > 0)
    table.from_urdf("resolution_rad", toml_number(field_rad / (*samples - 1)));
  else
    table.chosen("resolution_rad", toml_number(pi / 180));
}

void add_cone(Table& table, const XmlNode& sensor) {
  const auto max_m = number_below(sensor, "sonar/max"), radius_m = number_below(sensor, "sonar/radius");
  add_range(table, number_below(sensor, "sonar/min"), max_m);
  const bool said = max_m && radius_m && *max_m > 0 && *radius_m >= 0;
  add_number(table, "field_of_view_rad", said ? std::optional(2 * std::atan(*radius_m / *max_m)) : std::nullopt, 0, pi,
             0.35);
}

Table table_of_camera(const std::string& name, const Pose& X_BC, const XmlNode& sensor) {
  Table table{.name = "camera", .one_of_several = true, .entries = {}};
  table.from_urdf("name", toml_text(name));
  add_mount(table, X_BC);
  const auto pixels = [&](const char* key, const char* path, int otherwise) {
    const auto found = number_below(sensor, path);
    if (found && *found >= 16 && *found <= 4096 && *found == std::floor(*found))
      table.from_urdf(key, fmt::format("{:.0f}", *found));
    else
      table.chosen(key, std::to_string(otherwise));
  };
  pixels("width", "camera/image/width", 640);
  pixels("height", "camera/image/height", 480);
  add_number(table, "field_of_view_rad", number_below(sensor, "camera/horizontal_fov"), 0.01, 2.96, 1.2);
  add_number(table, "rate_hz", number_below(sensor, "update_rate"), 0.1, 120, 30);
  table.chosen("latency_s", "0.02");
  table.chosen("jpeg_quality", "80");
  return table;
}

// The description's type for Gazebo's; empty: none.
std::string type_for(const std::string& gazebo) {
  if (gazebo == "imu") return "IMU";
  if (gazebo == "gps" || gazebo == "navsat") return "GPS";
  if (gazebo == "contact") return "Touch";
  if (gazebo == "sonar") return "Sonar";
  if (gazebo == "ray" || gazebo == "gpu_ray" || gazebo == "lidar" || gazebo == "gpu_lidar") return "RangeScanner";
  if (gazebo.find("camera") != std::string::npos || gazebo == "depth") return "camera";
  return {};
}

}  // namespace

std::optional<Friction> friction_of(const UrdfModel& model, const std::vector<std::size_t>& links,
                                    std::vector<std::string>& warnings) {
  for (const std::size_t i : links) {
    const Link& link = model.links[i];
    for (const XmlNode* node : gazebo_of(model, link.name)) {
      const auto mu1 = number_below(*node, "mu1"), mu2 = number_below(*node, "mu2");
      if (!mu1 && !mu2) continue;
      Friction friction{in_range(mu1.value_or(mu2.value_or(0)), link.name, warnings),
                        in_range(mu2.value_or(mu1.value_or(0)), link.name, warnings)};
      if (fdir1_is_across(link, *node)) std::swap(friction.along, friction.across);
      return friction;
    }
  }
  return std::nullopt;
}

void append_gazebo_sensors(const UrdfModel& model, const Pose& X_FB, Draft& draft, std::vector<std::string>& warnings) {
  // The sensors that every description gets have their names already.
  std::set<std::string> names{"GroundTruth", "INS", "Encoder", "Odometry", "Tachometer", "Drives"}, camera_names;
  std::vector<Table> cameras;
  std::size_t sensors = 0;
  for (const XmlNode& gazebo : model.document.children)
    if (const Link* const found = link_named(model, gazebo))
      for (const XmlNode& sensor : gazebo.children) {
        const Link& link = *found;
        const std::string* const given = sensor.attribute("type");
        if (sensor.name != "sensor" || !given) continue;
        const std::string type = type_for(*given);
        const Pose X_BS = mount_of(link, sensor, X_FB);

        // Cameras are tables of their own and come last; unknown types, and those beyond the limits, are warned of.
        if (type.empty()) {
          warnings.push_back(fmt::format("link \"{}\": a description has no sensor of type \"{}\"", link.name, *given));
        } else if (type == "camera" ? cameras.size() == kMostCameras : sensors == kMostSensors) {
          warnings.push_back(fmt::format("link \"{}\": this sensor is one too many, and is left out", link.name));
        } else if (type == "camera") {
          cameras.push_back(table_of_camera(sensor_name(sensor, link.name, camera_names), X_BS, sensor));
        } else {
          Table table = table_of_sensor(type, sensor_name(sensor, link.name, names), X_BS, sensor);
          if (type == "Sonar") add_cone(table, sensor);
          if (type == "RangeScanner") {
            const XmlNode* const ray = sensor.child("ray") ? sensor.child("ray") : sensor.child("lidar");
            add_scan(table, ray ? *ray : sensor, X_BS);
          }
          draft.tables.push_back(std::move(table));
          ++sensors;
        }
      }
  std::ranges::move(cameras, std::back_inserter(draft.tables));
}

}  // namespace kenaf::describe
