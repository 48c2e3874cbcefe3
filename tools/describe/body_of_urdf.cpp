#include "tools/describe/body_of_urdf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kenaf::describe {
namespace {

using description::DescriptionError;

constexpr double kNotWorthAWord_m = 0.5e-3;
constexpr double kFarthest = 0.3;  // chosen: of its length, that the hull may move to the middle of the flippers

Eigen::AlignedBox3d hull_of(const UrdfModel& model, const Roles& roles, Meshes& meshes,
                            std::vector<std::string>& warnings) {
  const Eigen::AlignedBox3d hull = bounds_of(model, roles.hull, meshes);
  for (const std::size_t i : roles.hull)
    for (const Shape& shape : model.links[i].shapes)
      if (const auto found = meshes.complaints().find(shape.mesh); found != meshes.complaints().end())
        warnings.push_back(fmt::format("link \"{}\": the hull's box is without mesh {}: it {}", model.links[i].name,
                                       found->first, found->second));
  if (hull.isEmpty())
    throw DescriptionError(
        fmt::format("{}: the hull has no collision shape that can be read: give link \"{}\" a "
                    "<collision> with a box{}",
                    model.file, model.base, warnings.empty() ? "" : " (" + warnings.back() + ")"));
  if (!(hull.sizes().minCoeff() > 0))
    throw DescriptionError(fmt::format("{}: the hull's collision shapes are flat: {:.4g} x {:.4g} x {:.4g} m",
                                       model.file, hull.sizes().x(), hull.sizes().y(), hull.sizes().z()));
  return hull;
}

Eigen::Vector3d origin_of(const UrdfModel& model, const Eigen::AlignedBox3d& hull, const RunningGear& gear,
                          std::vector<std::string>& warnings) {
  Eigen::Vector3d origin_m = hull.center();
  if (gear.flippers) {
    const double off_m = origin_m.x() - gear.flippers->x_m;
    if (std::abs(off_m) > kFarthest * hull.sizes().x())
      throw DescriptionError(
          fmt::format("{}: the hull's middle is {:.0f} mm {} that of the flippers, where a description has "
                      "both in one; --hull chooses the links that make its box",
                      model.file, std::abs(off_m) * 1000, off_m > 0 ? "before" : "behind"));
    if (std::abs(off_m) > kNotWorthAWord_m)
      warnings.push_back(fmt::format("the hull's box moves {:.1f} mm {}, to the flippers' middle",
                                     std::abs(off_m) * 1000, off_m > 0 ? "back" : "forward"));
    origin_m.x() = gear.flippers->x_m;
  }
  if (const double off_m = origin_m.y() - gear.y_m; std::abs(off_m) > kNotWorthAWord_m)
    warnings.push_back(fmt::format("the hull's box moves {:.1f} mm to the {}, to the middle of tracks or wheels",
                                   std::abs(off_m) * 1000, off_m > 0 ? "right" : "left"));
  origin_m.y() = gear.y_m;
  return origin_m;
}

void warn_of_products(const Eigen::Matrix3d& I, std::vector<std::string>& warnings) {
  const double largest = std::max({std::abs(I(0, 1)), std::abs(I(0, 2)), std::abs(I(1, 2))});
  const double smallest = I.diagonal().minCoeff();
  if (largest > 1e-6 * smallest)
    warnings.push_back(
        fmt::format("products of inertia are left out: xy {:.3g}, xz {:.3g}, yz {:.3g} kg m2, up to {:.2g} % "
                    "of the smallest moment",
                    I(0, 1), I(0, 2), I(1, 2), 100 * largest / smallest));
}

}  // namespace

UrdfBody find_body(const UrdfModel& model, const Roles& roles, const RunningGear& gear, Meshes& meshes,
                   std::vector<std::string>& warnings) {
  const Eigen::AlignedBox3d hull = hull_of(model, roles, meshes, warnings);
  UrdfBody body;
  body.size_m = hull.sizes();
  body.X_FB.p = origin_of(model, hull, gear, warnings);
  std::vector<std::size_t> links;
  for (std::size_t i = 0; i < model.links.size(); ++i)
    if (roles.of_link[i] != Role::flipper) links.push_back(i);
  body.mass = moved(mass_of(model, links), inverse(body.X_FB));
  if (body.mass.mass_kg == 0)
    throw DescriptionError(
        fmt::format("{}: no link of the body has a mass; give \"{}\" an <inertial>", model.file, model.base));
  if (const std::string fault = inertia_fault(body.mass.inertia_kgm2); !fault.empty())
    throw DescriptionError(fmt::format("{}: all links of the body together have an inertia that no rigid body has: {}",
                                       model.file, fault));
  warn_of_products(body.mass.inertia_kgm2, warnings);
  return body;
}

}  // namespace kenaf::describe
