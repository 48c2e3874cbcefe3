#include "tools/describe/running_gear.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/describe/flipper_set.hpp"
#include "tools/describe/mirror_images.hpp"

namespace kenaf::describe {
namespace {

using description::DescriptionError;
using physics::Pose;
using Indices = std::vector<std::size_t>;

constexpr double kSmall_m = 0.5e-3;

struct PlacedShape {
  const Shape* shape;
  Pose X_FS;
};

std::vector<PlacedShape> placed_shapes(const UrdfModel& model, const Indices& links) {
  std::vector<PlacedShape> shapes;
  for (const std::size_t i : links)
    for (const Shape& shape : model.links[i].shapes)
      shapes.push_back({&shape, compose(model.links[i].X_FL, shape.X_LS)});
  return shapes;
}

bool is_round(const PlacedShape& placed) {
  return placed.shape->kind == Shape::Kind::cylinder || placed.shape->kind == Shape::Kind::sphere;
}

// The largest cylinder or sphere below a link, or else what is as high as its meshes and boxes, so that it stands as
// they do.
Rolling rolling_of(const UrdfModel& model, std::size_t head, Meshes& meshes) {
  const Indices links = subtree(model, head);
  const std::vector<PlacedShape> shapes = placed_shapes(model, links);
  const PlacedShape* largest = nullptr;
  for (const PlacedShape& placed : shapes)
    if (is_round(placed) && (!largest || placed.shape->radius_m > largest->shape->radius_m)) largest = &placed;
  if (largest) {
    Rolling rolling{head, largest->X_FS.p, largest->shape->radius_m, {}};
    if (largest->shape->kind == Shape::Kind::cylinder) rolling.width_m = largest->shape->length_m;
    return rolling;
  }
  const Eigen::AlignedBox3d bounds = bounds_of(model, links, meshes);
  if (bounds.isEmpty()) {
    std::string why = "has no collision shape; add a <collision> with a cylinder";
    for (const PlacedShape& placed : shapes)
      if (const auto found = meshes.complaints().find(placed.shape->mesh); found != meshes.complaints().end())
        why = fmt::format("has a mesh that cannot be read: {} {}", found->first, found->second);
    throw DescriptionError(fmt::format("{}: wheel \"{}\" {}", model.file, model.links[head].name, why));
  }
  return {head, bounds.center(), bounds.sizes().z() / 2, bounds.sizes().y()};
}

Rolling wheel_of(const UrdfModel& model, std::size_t head, Meshes& meshes, std::vector<std::string>& warnings) {
  Rolling wheel = rolling_of(model, head, meshes);
  const Link& link = model.links[head];
  for (const PlacedShape& placed : placed_shapes(model, subtree(model, head)))
    if (placed.shape->kind == Shape::Kind::cylinder && placed.shape->radius_m == wheel.radius_m &&
        !along_y(placed.X_FS.q.toRotationMatrix().col(2)))
      throw DescriptionError(
          fmt::format("{}: wheel \"{}\": its cylinder does not lie along the axle; give its <origin> "
                      "rpy=\"1.5707963 0 0\"",
                      model.file, link.name));
  const Eigen::Vector3d off_m = wheel.p_FW_m - link.X_FL.p;
  if (const double beside_m = std::hypot(off_m.x(), off_m.z()); link.moves() && beside_m > kSmall_m)
    warnings.push_back(fmt::format("wheel \"{}\": the centre of its shape is {:.1f} mm off its axle; the shape counts",
                                   link.name, beside_m * 1000));
  return wheel;
}

WheelPair pair_of(const UrdfModel& model, const Rolling& left, const Rolling& right, double y_m, double tolerance_m,
                  std::vector<std::string>& warnings) {
  MirrorImages both(model.file, model.links[left.link].name, model.links[right.link].name, tolerance_m);
  WheelPair pair{.left = left, .right = right, .x_m = 0, .half_gauge_m = 0, .z_m = 0, .radius_m = 0, .width_m = {}};
  pair.x_m = both.length_m("x", left.p_FW_m.x(), right.p_FW_m.x());
  pair.half_gauge_m = both.length_m("the distance to the middle", left.p_FW_m.y() - y_m, y_m - right.p_FW_m.y());
  pair.z_m = both.length_m("z", left.p_FW_m.z(), right.p_FW_m.z());
  pair.radius_m = both.length_m("radius", left.radius_m, right.radius_m);
  if (left.width_m && right.width_m) pair.width_m = both.length_m("width", *left.width_m, *right.width_m);
  both.check(warnings);
  return pair;
}

// Front to rear on each side, so that the n-th of both sides belong together.
std::vector<WheelPair> pairs_of(const UrdfModel& model, std::vector<Rolling> wheels, double& y_m, double tolerance_m,
                                std::vector<std::string>& warnings) {
  // The plane between the outermost wheels divides left from right.
  const auto by_y = [](const Rolling& a, const Rolling& b) { return a.p_FW_m.y() < b.p_FW_m.y(); };
  const auto [rightmost, leftmost] = std::ranges::minmax_element(wheels, by_y);
  y_m = (rightmost->p_FW_m.y() + leftmost->p_FW_m.y()) / 2;
  std::vector<Rolling> left, right;
  for (const Rolling& wheel : wheels) (wheel.p_FW_m.y() > y_m ? left : right).push_back(wheel);

  // Each side in order, and as many on both.
  const auto front_first = [](const Rolling& a, const Rolling& b) { return a.p_FW_m.x() > b.p_FW_m.x(); };
  std::ranges::stable_sort(left, front_first);
  std::ranges::stable_sort(right, front_first);
  if (left.size() != right.size())
    throw DescriptionError(
        fmt::format("{}: there are {} wheels on the left and {} on the right, among them \"{}\": wheels "
                    "come in pairs; --wheels chooses links",
                    model.file, left.size(), right.size(), model.links[wheels.front().link].name));

  // The n-th of both sides are mirror images, each behind the one before.
  std::vector<WheelPair> pairs;
  for (std::size_t i = 0; i < left.size(); ++i) {
    pairs.push_back(pair_of(model, left[i], right[i], y_m, tolerance_m, warnings));
    if (i > 0 && pairs[i].x_m >= pairs[i - 1].x_m - kSmall_m)
      throw DescriptionError(
          fmt::format("{}: wheels \"{}\" and \"{}\" are side by side: a description has one wheel a side "
                      "at a place; --wheels chooses links",
                      model.file, model.links[left[i - 1].link].name, model.links[left[i].link].name));
  }
  return pairs;
}

struct TrackSide {
  Indices links;
  Eigen::AlignedBox3d bounds;
  double end_radius_m = 0;
  bool radius_of_box = false;
};

TrackSide side_of(const UrdfModel& model, const Indices& links, Meshes& meshes, const char* side) {
  TrackSide track{.links = links, .bounds = bounds_of(model, links, meshes)};
  if (links.empty())
    throw DescriptionError(fmt::format("{}: no track is on the {}; --tracks chooses links", model.file, side));
  for (const PlacedShape& placed : placed_shapes(model, links))
    if (placed.shape->kind == Shape::Kind::cylinder && along_y(placed.X_FS.q.toRotationMatrix().col(2)))
      track.end_radius_m = std::max(track.end_radius_m, placed.shape->radius_m);
  if (track.end_radius_m == 0) {
    track.end_radius_m = track.bounds.sizes().z() / 2;
    track.radius_of_box = true;
  }
  if (track.bounds.sizes().x() <= 2 * track.end_radius_m)
    throw DescriptionError(
        fmt::format("{}: track \"{}\" is {:.4g} m long, which is no more than its {:.4g} m of height: a "
                    "track is a belt around two ends; is it a wheel?",
                    model.file, model.links[links.front()].name, track.bounds.sizes().x(), 2 * track.end_radius_m));
  return track;
}

TrackPair tracks_of(const UrdfModel& model, const Indices& links, Meshes& meshes, double& y_m, double tolerance_m,
                    std::vector<std::string>& warnings) {
  // Links with shapes are sorted to the sides of the middle; what has none is left out.
  Eigen::AlignedBox3d all = bounds_of(model, links, meshes);
  if (all.isEmpty())
    throw DescriptionError(
        fmt::format("{}: track \"{}\" has no collision shape that can be read; add a <collision> with a "
                    "box and two cylinders{}",
                    model.file, model.links[links.front()].name,
                    meshes.complaints().empty() ? "" : ", or give its mesh by --package"));
  y_m = all.center().y();
  Indices left_links, right_links;
  for (const std::size_t i : links) {
    const Eigen::AlignedBox3d bounds = bounds_of(model, {i}, meshes);
    if (bounds.isEmpty()) continue;
    (bounds.center().y() > y_m ? left_links : right_links).push_back(i);
  }
  const TrackSide left = side_of(model, left_links, meshes, "left"),
                  right = side_of(model, right_links, meshes, "right");

  // The belly is what carries: it lies half of the ends' height below the centre.
  MirrorImages both(model.file, model.links[left_links.front()].name, model.links[right_links.front()].name,
                    tolerance_m);
  TrackPair pair{.left = left_links,
                 .right = right_links,
                 .x_m = 0,
                 .half_gauge_m = 0,
                 .z_m = 0,
                 .length_m = 0,
                 .end_radius_m = 0,
                 .width_m = 0,
                 .radius_of_box = left.radius_of_box};
  pair.x_m = both.length_m("x", left.bounds.center().x(), right.bounds.center().x());
  pair.half_gauge_m =
      both.length_m("the distance to the middle", left.bounds.center().y() - y_m, y_m - right.bounds.center().y());
  pair.length_m = both.length_m("length", left.bounds.sizes().x(), right.bounds.sizes().x());
  pair.width_m = both.length_m("width", left.bounds.sizes().y(), right.bounds.sizes().y());
  pair.end_radius_m = both.length_m("radius", left.end_radius_m, right.end_radius_m);
  pair.z_m = both.length_m("z", left.bounds.min().z() + left.end_radius_m, right.bounds.min().z() + right.end_radius_m);
  both.check(warnings);
  if (const double higher_m = left.bounds.sizes().z() - 2 * left.end_radius_m; higher_m > kSmall_m)
    warnings.push_back(fmt::format("tracks: \"{}\" is {:.1f} mm higher than twice its ends' radius; its belly counts",
                                   model.links[left_links.front()].name, higher_m * 1000));
  return pair;
}

}  // namespace

MassProperties mass_of(const UrdfModel& model, const std::vector<std::size_t>& links) {
  MassProperties all;
  for (const std::size_t i : links)
    if (model.links[i].mass.mass_kg > 0) all = sum(all, model.links[i].mass);
  return all;
}

RunningGear find_running_gear(const UrdfModel& model, const Roles& roles, Meshes& meshes, double tolerance_m,
                              std::vector<std::string>& warnings) {
  RunningGear gear{};
  if (!roles.tracks.empty()) {
    gear.track = tracks_of(model, roles.tracks, meshes, gear.y_m, tolerance_m, warnings);
  } else {
    std::vector<Rolling> wheels;
    for (const std::size_t head : roles.wheels) wheels.push_back(wheel_of(model, head, meshes, warnings));
    gear.wheels = pairs_of(model, wheels, gear.y_m, tolerance_m, warnings);
    for (const std::size_t head : roles.casters) gear.casters.push_back(rolling_of(model, head, meshes));
  }
  if (!roles.casters.empty() && gear.track)
    warnings.push_back(fmt::format("\"{}\" and all other casters are left out: a robot on tracks has none",
                                   model.links[roles.casters.front()].name));
  if (!roles.flippers.empty())
    gear.flippers = find_flippers(model, roles.flippers, gear.y_m, meshes, tolerance_m, warnings);
  return gear;
}

}  // namespace kenaf::describe
