#include "tools/describe/to_urdf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "physics/robot_shapes.hpp"
#include "tools/describe/mass_properties.hpp"
#include "tools/describe/urdf_sensors.hpp"
#include "tools/describe/urdf_text.hpp"
#include "tools/describe/xml_tree.hpp"

namespace kenaf::describe {
namespace {

using Eigen::Vector3d;
using physics::CasterDescription;
using physics::FlipperDescription;
using physics::RobotDescription;
using physics::TrackDescription;

constexpr const char* kHullColour = "hull";
constexpr const char* kBeltColour = "rubber";

MassProperties mass_of_body(const physics::BodyDescription& body) {
  return {body.mass_kg, body.p_BBcm_m, body.inertia_kgm2.asDiagonal()};
}

// In the wheel's own frame, at its centre.
MassProperties mass_of_wheel(const RobotDescription& robot, const TrackDescription& wheel, double share) {
  // a solid cylinder's inertia m r^2 / 2 is felt at the rim as m / 2
  const double mass_kg = share * 2 * robot.drive.moving_mass_kg / static_cast<double>(robot.track.size());
  return {mass_kg, Vector3d::Zero(), cylinder_inertia(mass_kg, wheel.end_radius_m, wheel.width_m)};
}

Vector3d on_side(const Vector3d& p_left, bool left) {
  return {p_left.x(), left ? p_left.y() : -p_left.y(), p_left.z()};
}

struct MassesOfBody {
  MassProperties base;
  double share = 0;  // of the wheels' mass that they have
};

// Halves the wheels' mass until a rigid body is left of the body; none if that is never so.
MassesOfBody shared_masses(const RobotDescription& robot) {
  const MassProperties whole = mass_of_body(robot.body);
  if (!robot.has_wheels()) return {whole, 0};
  constexpr double kLeast = 1e-6;
  for (double share = 1; share > kLeast; share /= 2) {
    MassProperties wheels;
    for (const TrackDescription& wheel : robot.track)
      for (const bool left : {true, false})
        wheels = sum(wheels, moved(mass_of_wheel(robot, wheel, share),
                                   {on_side(wheel.p_BT_m, left), Eigen::Quaterniond::Identity()}));
    if (wheels.mass_kg < whole.mass_kg) {
      const MassProperties rest = difference(whole, wheels);
      if (inertia_fault(rest.inertia_kgm2).empty()) return {rest, share};
    }
  }
  return {whole, 0};
}

class UrdfMaker {
 public:
  explicit UrdfMaker(const RobotDescription& robot) : robot_(robot) {}

  MadeUrdf make() {
    add_base();
    if (robot_.has_wheels())
      add_wheels();
    else
      add_tracks();
    add_casters();
    if (robot_.has_flippers()) add_flippers();
    tree_ += sensor_frames(robot_, names_);
    say_what_is_left_out();
    return {fmt::format(
                "<?xml version=\"1.0\"?>\n"
                "<!-- {0}: made by kenaf-describe of the robot's description. SI units; x forward, y left, z up. -->\n"
                "<robot name=\"{0}\">\n"
                "  <material name=\"{1}\"><color rgba=\"0.85 0.45 0.1 1\"/></material>\n"
                "  <material name=\"{2}\"><color rgba=\"0.15 0.15 0.15 1\"/></material>\n{3}{4}</robot>\n",
                name_in_comment(), kHullColour, kBeltColour, tree_, friction_),
            std::move(left_out_)};
  }

 private:
  // A comment must not hold two dashes.
  std::string name_in_comment() const {
    std::string name = xml_escaped(robot_.name);
    for (std::size_t at = name.find("--"); at != std::string::npos; at = name.find("--")) name.erase(at, 1);
    while (name.ends_with('-')) name.pop_back();
    return name.empty() ? "robot" : name;
  }

  void add_link(const std::string& name, const MassProperties& mass, const std::vector<UrdfShape>& shapes,
                const char* colour) {
    names_.insert(name);
    tree_ += link_text(name, mass, shapes, colour);
  }

  void add_base() {
    masses_ = shared_masses(robot_);
    add_link("base_footprint", {}, {}, "");
    add_link("base_link", masses_.base, {box_shape(robot_.body.size_m, Vector3d::Zero())}, kHullColour);
    tree_ +=
        fixed_joint("base_footprint", "base_link", {{0, 0, robot_.ride_height_m()}, Eigen::Quaterniond::Identity()});
    friction_ += friction_text("base_link", robot_.body.friction, robot_.body.friction, false);
  }

  void add_tracks() {
    const TrackDescription& track = robot_.track.front();
    const double half_m = track.straight_m() / 2;
    const std::vector<UrdfShape> shapes{
        box_shape({track.straight_m(), track.width_m, 2 * track.end_radius_m}, Vector3d::Zero()),
        cylinder_along_y(track.end_radius_m, track.width_m, {half_m, 0, 0}),
        cylinder_along_y(track.end_radius_m, track.width_m, {-half_m, 0, 0})};
    for (const bool left : {true, false}) {
      const std::string name = left ? "left_track" : "right_track";
      add_link(name, {}, shapes, kBeltColour);
      tree_ += fixed_joint("base_link", name, {on_side(track.p_BT_m, left), Eigen::Quaterniond::Identity()});
      friction_ += friction_text(name, track.friction_along, track.friction_across, false);
    }
  }

  // One pair is left and right, two are front and rear, more have numbers from the front.
  std::string pair_name(std::size_t pair) const {
    if (robot_.track.size() == 1) return "";
    if (robot_.track.size() == 2) return pair == 0 ? "front_" : "rear_";
    return fmt::format("axle_{}_", pair + 1);
  }

  void add_wheels() {
    const physics::TrackDriveDescription& drive = robot_.drive;
    for (std::size_t pair = 0; pair < robot_.track.size(); ++pair) {
      const TrackDescription& wheel = robot_.track[pair];
      const double radius_m = wheel.end_radius_m;
      for (const bool left : {true, false}) {
        const std::string name = pair_name(pair) + (left ? "left_wheel" : "right_wheel");
        add_link(name, mass_of_wheel(robot_, wheel, masses_.share),
                 {cylinder_along_y(radius_m, wheel.width_m, Vector3d::Zero())}, kBeltColour);
        tree_ += turning_joint({.parent = "base_link",
                                .child = name,
                                .p_ParentChild_m = on_side(wheel.p_BT_m, left),
                                .axis = Vector3d::UnitY(),
                                .effort_nm = drive.max_force_n * radius_m / static_cast<double>(robot_.track.size()),
                                .velocity_radps = drive.max_speed_mps / radius_m,
                                .limited = false});
        friction_ += friction_text(name, wheel.friction_along, wheel.friction_across, true);
      }
    }
  }

  void add_casters() {
    for (std::size_t i = 0; i < robot_.caster.size(); ++i) {
      const CasterDescription& caster = robot_.caster[i];
      const std::string name = robot_.caster.size() == 1 ? "caster" : fmt::format("caster_{}", i + 1);
      add_link(name, {}, {cylinder_along_y(caster.radius_m, caster.width_m, Vector3d::Zero())}, kBeltColour);
      tree_ += fixed_joint("base_link", name, {caster.p_BC_m, Eigen::Quaterniond::Identity()});
      friction_ += friction_text(name, caster.friction, caster.friction, false);
    }
  }

  // Both drums, and between them the box of the smaller one's height.
  void add_flippers() {
    const FlipperDescription& f = robot_.flipper.front();
    for (const bool front : {true, false})
      for (const bool left : {true, false}) {
        if (!robot_.has(front ? robot::kFrontLeft : robot::kRearLeft)) continue;
        const double ahead = front ? 1 : -1;
        const std::string name = fmt::format("{}_{}_flipper", front ? "front" : "rear", left ? "left" : "right");
        const double height_m = 2 * std::min(f.pivot_radius_m, f.tip_radius_m);
        add_link(name, mass_of_flipper(f, front),
                 {cylinder_along_y(f.pivot_radius_m, f.width_m, Vector3d::Zero()),
                  cylinder_along_y(f.tip_radius_m, f.width_m, {ahead * f.length_m, 0, 0}),
                  box_shape({f.length_m, f.width_m, height_m}, {ahead * f.length_m / 2, 0, 0})},
                 kBeltColour);
        // about -y, x turns up; a rear one's tip is at -x
        tree_ += turning_joint({.parent = "base_link",
                                .child = name,
                                .p_ParentChild_m = on_side(f.p_BPivot_m.cwiseProduct(Vector3d(ahead, 1, 1)), left),
                                .axis = Vector3d(0, -ahead, 0),
                                .effort_nm = robot_.servo.max_torque_nm,
                                .velocity_radps = robot_.servo.max_speed_radps,
                                .limited = true,
                                .lower_rad = f.min_angle_rad,
                                .upper_rad = f.max_angle_rad});
        friction_ += friction_text(name, f.friction_along, f.friction_across, false);
      }
  }

  // As the simulator's: a uniform prism of the belt's outline.
  static MassProperties mass_of_flipper(const FlipperDescription& f, bool front) {
    const physics::OutlineMoments m = physics::moments(physics::flipper_outline(f));
    const double xx = f.mass_kg * m.Ixx / m.area, zz = f.mass_kg * m.Izz / m.area;
    const double yy = f.mass_kg * f.width_m * f.width_m / 12;
    return {f.mass_kg, Vector3d(front ? m.centroid.x() : -m.centroid.x(), 0, m.centroid.y()),
            Vector3d(zz + yy, xx + zz, xx + yy).asDiagonal()};
  }

  void say_what_is_left_out() {
    left_out_.emplace_back("battery, currents, encoder, time constants, noise and effects");
    if (!robot_.has_wheels()) left_out_.emplace_back("the tracks' drive: a URDF has no belts, so tracks are fixed");
    if (robot_.has_flippers())
      left_out_.emplace_back("the flippers' start angle, their encoder and whether a belt runs on them");
    if (!robot_.mission_packages.empty())
      left_out_.emplace_back("mission packages: their cameras are fixed at position 0");
    if (robot_.has_wheels() && masses_.share < 1)
      left_out_.push_back(
          fmt::format("{:.3g} of the wheels' moving mass: [body] is too light for more", 1 - masses_.share));
  }

  const RobotDescription& robot_;
  MassesOfBody masses_;
  std::set<std::string> names_;
  std::string tree_, friction_;
  std::vector<std::string> left_out_;
};

}  // namespace

MadeUrdf to_urdf(const RobotDescription& robot) {
  return UrdfMaker(robot).make();
}

}  // namespace kenaf::describe
