#include "tools/describe/roles.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <regex>

namespace kenaf::describe {
namespace {

using description::DescriptionError;
using Indices = std::vector<std::size_t>;

constexpr double kMiddle_m = 0.01;         // chosen: no pair of wheels is so close
constexpr double kOnGround_m = 0.02;       // chosen: casters that hang in springs
constexpr std::size_t kFewestRollers = 3;  // of a mecanum wheel
constexpr const char* kTrackNames = "track(?!ing|er)|crawler|tread";
constexpr const char* kFlipperNames = "flipper|paddle";
constexpr const char* kCasterNames = "cast[eo]r|swivel|ball_?wheel|free_?wheel";
constexpr const char* kWheelNames = "wheel|tyre|tire";
constexpr const char* kMecanumNames = "mecanum|omni_?wheel|swedish";

std::regex expression(const std::string& text, const char* option) {
  try {
    return std::regex(text, std::regex::ECMAScript | std::regex::icase | std::regex::optimize);
  } catch (const std::regex_error& error) {
    throw DescriptionError(fmt::format("{} '{}' is no regular expression: {}", option, text, error.what()));
  }
}

bool matches(const std::string& name, const std::regex& pattern) {
  return std::regex_search(name, pattern);
}

class RoleFinder {
 public:
  RoleFinder(const UrdfModel& model, const RoleChoice& choice, Meshes& meshes, std::vector<std::string>& warnings)
      : model_(model),
        choice_(choice),
        meshes_(meshes),
        warnings_(warnings),
        wheels_(expression(choice.wheels.empty() ? kWheelNames : choice.wheels, "--wheels")),
        tracks_(expression(choice.tracks.empty() ? kTrackNames : choice.tracks, "--tracks")),
        flippers_(expression(choice.flippers.empty() ? kFlipperNames : choice.flippers, "--flippers")),
        hull_(expression(choice.hull, "--hull")),
        casters_(expression(kCasterNames, "")),
        mecanum_(expression(kMecanumNames, "")) {}

  Roles find() {
    assign();
    take_corners_for_flippers();
    take_middle_for_casters();
    collect();
    check();
    return std::move(roles_);
  }

 private:
  const Link& link(std::size_t i) const { return model_.links[i]; }
  Role& role(std::size_t i) { return roles_.of_link[i]; }
  [[noreturn]] void fail(const std::string& what) const { throw DescriptionError(model_.file + ": " + what); }

  // Parents come first, so what hangs on a wheel, caster or flipper is part of it.
  void assign() {
    roles_.of_link.assign(model_.links.size(), Role::hull);
    for (std::size_t i = 0; i < model_.links.size(); ++i) {
      const Role above = i == 0 ? Role::hull : role(link(i).parent);
      role(i) = above == Role::hull || above == Role::track ? own_role(i, above) : above;
    }
  }

  Role own_role(std::size_t i, Role above) const {
    const Link& l = link(i);
    const bool turns = l.joint.kind == JointKind::revolute || l.joint.kind == JointKind::continuous;
    if (turns && matches(l.name, flippers_)) {
      if (!along_y(l.joint.axis_F))
        fail(fmt::format("joint \"{}\" turns flipper \"{}\" about {}, not about y", l.joint.name, l.name,
                         words(l.joint.axis_F)));
      return Role::flipper;
    }
    const bool chosen_wheel = !choice_.wheels.empty() && matches(l.name, wheels_);
    if (!chosen_wheel && matches(l.name, tracks_)) return Role::track;
    if (above == Role::track && l.joint.kind == JointKind::continuous && !chosen_wheel)
      return Role::track;  // its rollers
    if (!chosen_wheel && i > 0 && matches(l.name, casters_)) return Role::caster;
    if (chosen_wheel || (choice_.wheels.empty() && looks_like_a_wheel(i))) return Role::wheel;
    return Role::hull;
  }

  bool looks_like_a_wheel(std::size_t i) const {
    const Link& l = link(i);
    if (l.joint.kind != JointKind::continuous) return false;
    const bool named = matches(l.name, wheels_) || matches(l.joint.name, wheels_);
    if (matches(l.name, mecanum_))
      fail(fmt::format(
          "link \"{}\" is a mecanum or omni wheel: a description has none, as its robots do not drive sideways",
          l.name));
    if (!along_y(l.joint.axis_F)) {
      if (named && has_round_shape(i) && std::abs(l.joint.axis_F.z()) < 0.9)
        fail(fmt::format(
            "joint \"{}\" turns wheel \"{}\" about {} of \"{}\", not about y: a description has neither mecanum "
            "nor tilted wheels",
            l.joint.name, l.name, words(l.joint.axis_F), model_.base));
      return false;
    }
    return has_round_shape(i) || (named && has_mesh(i));
  }

  bool has_round_shape(std::size_t i) const {
    return std::ranges::any_of(subtree(model_, i), [this](std::size_t below) {
      return std::ranges::any_of(link(below).shapes, [](const Shape& shape) {
        return shape.kind == Shape::Kind::cylinder || shape.kind == Shape::Kind::sphere;
      });
    });
  }

  bool has_mesh(std::size_t i) const {
    return std::ranges::any_of(subtree(model_, i), [this](std::size_t below) {
      return std::ranges::any_of(link(below).shapes, [](const Shape& s) { return s.kind == Shape::Kind::mesh; });
    });
  }

  Indices heads(Role wanted) {
    Indices found;
    for (std::size_t i = 0; i < model_.links.size(); ++i)
      if (role(i) == wanted && (i == 0 || role(link(i).parent) != wanted)) found.push_back(i);
    return found;
  }

  void give(std::size_t head, Role given) {
    for (const std::size_t i : subtree(model_, head)) role(i) = given;
  }

  // Four links of no other role on revolute joints about y, one in each quarter.
  void take_corners_for_flippers() {
    if (!choice_.flippers.empty() || !heads(Role::flipper).empty() || !heads(Role::wheel).empty()) return;
    Indices corners;
    Eigen::AlignedBox3d places;
    for (std::size_t i = 1; i < model_.links.size(); ++i)
      if (role(i) == Role::hull && link(i).joint.kind == JointKind::revolute && along_y(link(i).joint.axis_F)) {
        corners.push_back(i);
        places.extend(link(i).X_FL.p);
      }
    if (corners.size() != 4) return;
    const Eigen::Vector3d middle = places.center();
    std::array<int, 4> quarters{};
    for (const std::size_t i : corners) {
      const Eigen::Vector3d d = link(i).X_FL.p - middle;
      if (std::abs(d.x()) < kMiddle_m || std::abs(d.y()) < kMiddle_m) return;
      ++quarters[(d.x() > 0 ? 0U : 1U) + (d.y() > 0 ? 0U : 2U)];
    }
    if (std::ranges::any_of(quarters, [](int n) { return n != 1; })) return;
    for (const std::size_t i : corners) give(i, Role::flipper);
  }

  // The middle is that of the outermost wheels.
  void take_middle_for_casters() {
    Eigen::AlignedBox3d wheels;
    double ground_m = std::numeric_limits<double>::infinity();
    for (const std::size_t i : heads(Role::wheel)) {
      wheels.extend(link(i).X_FL.p);
      ground_m = std::min(ground_m, lowest_m(i));
    }
    if (wheels.isEmpty()) return;
    const double middle_m = wheels.center().y();
    if (wheels.sizes().y() > 2 * kMiddle_m)
      for (const std::size_t i : heads(Role::wheel))
        if (std::abs(link(i).X_FL.p.y() - middle_m) < kMiddle_m) give(i, Role::caster);
    for (std::size_t i = 1; i < model_.links.size(); ++i)
      if (role(i) == Role::hull && is_ball(i, middle_m) && std::abs(lowest_m(i) - ground_m) < kOnGround_m)
        role(i) = Role::caster;
  }

  bool is_ball(std::size_t i, double middle_m) const {
    const Link& l = link(i);
    return l.shapes.size() == 1 && l.shapes.front().kind == Shape::Kind::sphere &&
           std::abs(compose(l.X_FL, l.shapes.front().X_LS).p.y() - middle_m) < kMiddle_m;
  }

  double lowest_m(std::size_t i) {
    const Eigen::AlignedBox3d bounds = bounds_of(model_, subtree(model_, i), meshes_);
    return bounds.isEmpty() ? std::numeric_limits<double>::infinity() : bounds.min().z();
  }

  void collect() {
    roles_.wheels = heads(Role::wheel);
    roles_.casters = heads(Role::caster);
    roles_.flippers = heads(Role::flipper);
    for (std::size_t i = 0; i < model_.links.size(); ++i) {
      if (role(i) == Role::track) roles_.tracks.push_back(i);
      if (role(i) == Role::hull && (choice_.hull.empty() || matches(link(i).name, hull_))) roles_.hull.push_back(i);
      const bool tilts = role(i) == Role::track && link(i).joint.kind == JointKind::revolute;
      if (role(i) != Role::hull && !tilts) continue;
      const bool matters = link(i).mass.mass_kg > 0 || !link(i).shapes.empty();
      if (link(i).moves() && matters)
        warnings_.push_back(
            fmt::format("joint \"{}\" moves link \"{}\", which counts as fixed, at the joint's position 0",
                        link(i).joint.name, link(i).name));
    }
  }

  void check() {
    for (const std::size_t i : roles_.wheels) {
      check_rollers(i);
      check_steering(i);
    }
    if (!roles_.tracks.empty() && !roles_.wheels.empty())
      fail(
          fmt::format("there are tracks (\"{}\") and wheels (\"{}\"): a description has one of both. --tracks "
                      "'{}|{}' takes these wheels for parts of the tracks, --wheels '^$' has no link for a wheel",
                      link(roles_.tracks.front()).name, link(roles_.wheels.front()).name,
                      choice_.tracks.empty() ? "track" : choice_.tracks, "wheel"));
    if (roles_.tracks.empty() && roles_.wheels.empty())
      fail(fmt::format(
          "there are neither wheels (a cylinder on a continuous joint about y) nor tracks (links named so); "
          "choose them by --wheels or --tracks among: {}",
          fmt::join(names(), ", ")));
    if (!roles_.wheels.empty() && !roles_.flippers.empty())
      fail(
          fmt::format("there are flippers (\"{}\") and wheels (\"{}\"): in a description, flippers belong to robots on "
                      "tracks; --tracks takes links for parts of tracks",
                      link(roles_.flippers.front()).name, link(roles_.wheels.front()).name));
  }

  void check_rollers(std::size_t wheel) const {
    std::size_t rollers = 0;
    for (const std::size_t i : subtree(model_, wheel))
      if (i != wheel && link(i).moves() && !link(i).shapes.empty()) ++rollers;
    if (rollers >= kFewestRollers)
      fail(fmt::format(
          "wheel \"{}\" has {} links that turn on it, as a mecanum wheel's rollers do: a description has none",
          link(wheel).name, rollers));
  }

  void check_steering(std::size_t wheel) {
    for (std::size_t up = link(wheel).parent; up != 0; up = link(up).parent) {
      if (!link(up).moves()) continue;
      if (std::abs(link(up).joint.axis_F.z()) > 0.5 && link(up).joint.kind != JointKind::other)
        fail(fmt::format(
            "joint \"{}\" steers wheel \"{}\": the wheels of a description do not steer. If it is a caster, name "
            "its link so",
            link(up).joint.name, link(wheel).name));
    }
  }

  std::vector<std::string> names() const {
    constexpr std::size_t kSome = 20;
    std::vector<std::string> all;
    for (const Link& l : model_.links) all.push_back(l.name);
    if (all.size() > kSome) {
      all.resize(kSome);
      all.emplace_back("...");
    }
    return all;
  }

  static std::string words(const Eigen::Vector3d& v) {
    return fmt::format("({:.3g} {:.3g} {:.3g})", v.x(), v.y(), v.z());
  }

  const UrdfModel& model_;
  const RoleChoice& choice_;
  Meshes& meshes_;
  std::vector<std::string>& warnings_;
  std::regex wheels_, tracks_, flippers_, hull_, casters_, mecanum_;
  Roles roles_;
};

}  // namespace

Roles find_roles(const UrdfModel& model, const RoleChoice& choice, Meshes& meshes, std::vector<std::string>& warnings) {
  return RoleFinder(model, choice, meshes, warnings).find();
}

std::vector<std::size_t> subtree(const UrdfModel& model, std::size_t link) {
  std::vector<bool> inside(model.links.size(), false);
  std::vector<std::size_t> found;
  for (std::size_t i = link; i < model.links.size(); ++i) {
    inside[i] = i == link || (i > 0 && inside[model.links[i].parent]);
    if (inside[i]) found.push_back(i);
  }
  return found;
}

bool along_y(const Eigen::Vector3d& axis_F) {
  constexpr double kTilted_rad = 0.02;  // chosen: rounded angles, but no camber that shows
  return std::hypot(axis_F.x(), axis_F.z()) < kTilted_rad * std::abs(axis_F.y());
}

}  // namespace kenaf::describe
