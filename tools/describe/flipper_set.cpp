#include "tools/describe/flipper_set.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "tools/describe/mirror_images.hpp"

namespace kenaf::describe {
namespace {

using description::DescriptionError;
using physics::Pose;
using std::numbers::pi;

// In the x-z plane, as it stands at the joint's position 0.
struct Arm {
  Eigen::Vector2d to_tip;  // from the pivot to the tip drum's centre
  double pivot_radius_m, tip_radius_m;
};

struct Flipper {
  std::size_t link;
  Eigen::Vector3d p_FPivot_m;  // y: of the middle of its width
  double mass_kg, length_m, pivot_radius_m, tip_radius_m, width_m, min_angle_rad, max_angle_rad;
};

Eigen::Vector2d xz(const Eigen::Vector3d& p) {
  return {p.x(), p.z()};
}

std::vector<std::pair<const Shape*, Pose>> shapes_below(const UrdfModel& model, std::size_t head) {
  std::vector<std::pair<const Shape*, Pose>> shapes;
  for (const std::size_t i : subtree(model, head))
    for (const Shape& shape : model.links[i].shapes)
      shapes.emplace_back(&shape, compose(model.links[i].X_FL, shape.X_LS));
  return shapes;
}

// Two drums: the cylinders that are nearest to the pivot and farthest from it.
std::optional<Arm> arm_of_drums(const UrdfModel& model, std::size_t head) {
  const Eigen::Vector2d pivot = xz(model.links[head].X_FL.p);
  std::vector<std::pair<double, Arm>> drums;  // by their distance; each knows itself as the tip
  for (const auto& [shape, X_FS] : shapes_below(model, head))
    if (shape->kind == Shape::Kind::cylinder && along_y(X_FS.q.toRotationMatrix().col(2))) {
      const Eigen::Vector2d to_drum = xz(X_FS.p) - pivot;
      drums.push_back({to_drum.norm(), {to_drum, 0, shape->radius_m}});
    }
  if (drums.size() < 2) return std::nullopt;
  const auto [nearest, farthest] =
      std::ranges::minmax_element(drums, {}, [](const std::pair<double, Arm>& drum) { return drum.first; });
  return Arm{farthest->second.to_tip, nearest->second.tip_radius_m, farthest->second.tip_radius_m};
}

// For want of drums: a bar with round ends, which points from the pivot to the middle of the shapes.
Arm arm_of_bounds(const UrdfModel& model, std::size_t head, Meshes& meshes) {
  const Link& link = model.links[head];
  const auto shapes = shapes_below(model, head);
  Eigen::AlignedBox3d placed;
  for (const auto& [shape, X_FS] : shapes) placed.extend(bounds_of(*shape, X_FS, meshes));
  const Eigen::Vector2d to_middle =
      placed.isEmpty() ? Eigen::Vector2d::Zero() : Eigen::Vector2d(xz(placed.center() - link.X_FL.p));
  if (to_middle.norm() < 1e-3)
    throw DescriptionError(
        fmt::format("{}: flipper \"{}\" has no collision shape that reaches out from its joint; add a "
                    "<collision> with a cylinder at the pivot and one at the tip",
                    model.file, link.name));
  const Eigen::Vector2d out = to_middle.normalized();
  const Pose X_FArm{link.X_FL.p,
                    Eigen::Quaterniond(Eigen::AngleAxisd(-std::atan2(out.y(), out.x()), Eigen::Vector3d::UnitY()))};
  Eigen::AlignedBox3d along;
  for (const auto& [shape, X_FS] : shapes) along.extend(bounds_of(*shape, compose(inverse(X_FArm), X_FS), meshes));
  const double radius_m = along.sizes().z() / 2;
  return {(along.max().x() - radius_m) * out, radius_m, radius_m};
}

// Angles count from straight out, tip up. About +y, a joint turns x towards -z: a front tip down, a rear tip up.
void set_angles(Flipper& flipper, const UrdfJoint& joint, const Eigen::Vector2d& to_tip, bool front) {
  constexpr double kRounded_rad = 1e-9;
  flipper.min_angle_rad = -pi;
  flipper.max_angle_rad = pi;
  if (joint.kind == JointKind::continuous) return;
  double at_zero_rad = std::atan2(to_tip.y(), front ? to_tip.x() : -to_tip.x());
  if (std::abs(at_zero_rad) < kRounded_rad) at_zero_rad = 0;
  const double up = (front ? -1 : 1) * (joint.axis_F.y() > 0 ? 1 : -1);
  flipper.min_angle_rad = at_zero_rad + (up > 0 ? joint.lower_rad : -joint.upper_rad);
  flipper.max_angle_rad = at_zero_rad + (up > 0 ? joint.upper_rad : -joint.lower_rad);
}

Flipper flipper_of(const UrdfModel& model, std::size_t head, bool front, Meshes& meshes) {
  const Link& link = model.links[head];
  const std::vector<std::size_t> links = subtree(model, head);
  const Arm arm = [&] {
    if (const auto drums = arm_of_drums(model, head)) return *drums;
    return arm_of_bounds(model, head, meshes);
  }();
  const Eigen::AlignedBox3d bounds = bounds_of(model, links, meshes);
  Flipper flipper{};
  flipper.link = head;
  flipper.p_FPivot_m = {link.X_FL.p.x(), bounds.center().y(), link.X_FL.p.z()};
  flipper.mass_kg = mass_of(model, links).mass_kg;
  flipper.length_m = arm.to_tip.norm();
  flipper.pivot_radius_m = arm.pivot_radius_m;
  flipper.tip_radius_m = arm.tip_radius_m;
  flipper.width_m = bounds.sizes().y();
  set_angles(flipper, link.joint, arm.to_tip, front);
  return flipper;
}

// Front left, front right, rear left, rear right.
std::vector<std::size_t> in_order(const UrdfModel& model, std::vector<std::size_t> heads, double y_m) {
  const auto x_of = [&](std::size_t i) { return model.links[i].X_FL.p.x(); };
  const auto y_of = [&](std::size_t i) { return model.links[i].X_FL.p.y(); };
  std::vector<std::string> names;
  for (const std::size_t i : heads) names.push_back(model.links[i].name);
  const auto fail = [&] {
    throw DescriptionError(
        fmt::format("{}: the flippers are {}: a description has four, one pair in front and one behind; "
                    "--flippers chooses links",
                    model.file, fmt::join(names, ", ")));
  };
  if (heads.size() != 4) fail();
  std::ranges::stable_sort(heads, std::ranges::greater(), x_of);
  if (y_of(heads[0]) < y_of(heads[1])) std::swap(heads[0], heads[1]);
  if (y_of(heads[2]) < y_of(heads[3])) std::swap(heads[2], heads[3]);
  if (!(y_of(heads[0]) > y_m && y_of(heads[1]) < y_m && y_of(heads[2]) > y_m && y_of(heads[3]) < y_m)) fail();
  return heads;
}

// The mean of two, which must be mirror images: left and right, or front and rear.
Flipper mean_of(const UrdfModel& model, const Flipper& a, const Flipper& b, double y_m, double tolerance_m,
                std::vector<std::string>& warnings) {
  const auto beside_m = [y_m](const Flipper& f) { return std::abs(f.p_FPivot_m.y() - y_m); };
  MirrorImages both(model.file, model.links[a.link].name, model.links[b.link].name, tolerance_m);
  Flipper mean = a;
  mean.p_FPivot_m.y() = y_m + both.length_m("the distance to the middle", beside_m(a), beside_m(b));
  mean.p_FPivot_m.z() = both.length_m("z", a.p_FPivot_m.z(), b.p_FPivot_m.z());
  mean.mass_kg = both.mass_kg("mass", a.mass_kg, b.mass_kg);
  mean.length_m = both.length_m("length", a.length_m, b.length_m);
  mean.pivot_radius_m = both.length_m("the pivot's radius", a.pivot_radius_m, b.pivot_radius_m);
  mean.tip_radius_m = both.length_m("the tip's radius", a.tip_radius_m, b.tip_radius_m);
  mean.width_m = both.length_m("width", a.width_m, b.width_m);
  mean.min_angle_rad = both.angle_rad("the lower limit", a.min_angle_rad, b.min_angle_rad);
  mean.max_angle_rad = both.angle_rad("the upper limit", a.max_angle_rad, b.max_angle_rad);
  both.check(warnings);
  return mean;
}

double mean_x_m(const UrdfModel& model, const Flipper& left, const Flipper& right, double tolerance_m,
                std::vector<std::string>& warnings) {
  MirrorImages both(model.file, model.links[left.link].name, model.links[right.link].name, tolerance_m);
  const double x_m = both.length_m("x", left.p_FPivot_m.x(), right.p_FPivot_m.x());
  both.check(warnings);
  return x_m;
}

// Straight out, 0, is within a description's limits, and those within a turn of it.
void bring_limits_around_zero(Flipper& flipper, std::vector<std::string>& warnings) {
  double& min = flipper.min_angle_rad;
  double& max = flipper.max_angle_rad;
  const double turns = min > 0 ? -std::ceil(min / (2 * pi)) : max < 0 ? std::ceil(-max / (2 * pi)) : 0;
  if (turns != 0 && min + turns * 2 * pi <= 0 && max + turns * 2 * pi >= 0) {
    min += turns * 2 * pi;
    max += turns * 2 * pi;
  }
  const double least = std::clamp(min, -2 * pi, 0.0), most = std::clamp(max, 0.0, 2 * pi);
  if (least != min || most != max)
    warnings.push_back(
        fmt::format("the flippers' limits of {:.5g} to {:.5g} rad become {:.5g} to {:.5g}: 0, straight out, is "
                    "among a description's angles, and 2 pi is the most",
                    min, max, least, most));
  min = least;
  max = most;
}

}  // namespace

FlipperSet find_flippers(const UrdfModel& model, const std::vector<std::size_t>& heads, double y_m, Meshes& meshes,
                         double tolerance_m, std::vector<std::string>& warnings) {
  // Each by itself, then left with right, then front with rear.
  const std::vector<std::size_t> links = in_order(model, heads, y_m);
  std::vector<Flipper> each;
  for (std::size_t i = 0; i < links.size(); ++i) each.push_back(flipper_of(model, links[i], i < 2, meshes));
  const double front_x_m = mean_x_m(model, each[0], each[1], tolerance_m, warnings),
               rear_x_m = mean_x_m(model, each[2], each[3], tolerance_m, warnings);
  const Flipper front = mean_of(model, each[0], each[1], y_m, tolerance_m, warnings),
                rear = mean_of(model, each[2], each[3], y_m, tolerance_m, warnings);
  Flipper all = mean_of(model, front, rear, y_m, tolerance_m, warnings);
  bring_limits_around_zero(all, warnings);

  const UrdfJoint& joint = model.links[links.front()].joint;
  return {.links = links,
          .x_m = (front_x_m + rear_x_m) / 2,
          .half_length_m = (front_x_m - rear_x_m) / 2,
          .half_gauge_m = all.p_FPivot_m.y() - y_m,
          .z_m = all.p_FPivot_m.z(),
          .mass_kg = all.mass_kg,
          .length_m = all.length_m,
          .pivot_radius_m = all.pivot_radius_m,
          .tip_radius_m = all.tip_radius_m,
          .width_m = all.width_m,
          .min_angle_rad = all.min_angle_rad,
          .max_angle_rad = all.max_angle_rad,
          .limited = joint.kind == JointKind::revolute,
          .effort_nm = joint.effort,
          .velocity_radps = joint.velocity};
}

}  // namespace kenaf::describe
