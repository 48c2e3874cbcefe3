#include "tools/describe/urdf_model.hpp"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>

#include "tools/describe/urdf_structure.hpp"

namespace kenaf::describe {
namespace {

using description::DescriptionError;
using physics::Pose;

// liburdfdom says what is wrong to console_bridge only.
class Complaints final : public console_bridge::OutputHandler {
 public:
  Complaints() : before_(console_bridge::getOutputHandler()) { console_bridge::useOutputHandler(this); }
  ~Complaints() override {
    if (before_)
      console_bridge::useOutputHandler(before_);
    else
      console_bridge::noOutputHandler();
  }
  Complaints(const Complaints&) = delete;
  Complaints& operator=(const Complaints&) = delete;
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) texts.push_back(text);
  }
  std::vector<std::string> texts;

 private:
  console_bridge::OutputHandler* before_;
};

urdf::ModelInterfaceSharedPtr by_liburdfdom(std::string_view xml, const std::string& file) {
  Complaints complaints;
  std::string thrown;
  try {
    if (auto model = urdf::parseURDF(std::string(xml))) return model;
  } catch (const std::exception& error) {
    thrown = error.what();
  }
  if (!thrown.empty()) complaints.texts.push_back(thrown);
  throw DescriptionError(fmt::format("{}: {}", file, fmt::join(complaints.texts, "; ")));
}

Eigen::Vector3d vector_of(const urdf::Vector3& v) {
  return {v.x, v.y, v.z};
}

Pose pose_of(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  return {vector_of(pose.position), Eigen::Quaterniond(r.w, r.x, r.y, r.z)};
}

Shape shape_of(const urdf::Collision& collision) {
  Shape shape{Shape::Kind::box, Eigen::Vector3d::Zero(), 0, 0, {}, pose_of(collision.origin)};
  if (const auto box = urdf::dynamic_pointer_cast<urdf::Box>(collision.geometry)) {
    shape.size_m = vector_of(box->dim);
  } else if (const auto cylinder = urdf::dynamic_pointer_cast<urdf::Cylinder>(collision.geometry)) {
    shape.kind = Shape::Kind::cylinder;
    shape.radius_m = cylinder->radius;
    shape.length_m = cylinder->length;
  } else if (const auto sphere = urdf::dynamic_pointer_cast<urdf::Sphere>(collision.geometry)) {
    shape.kind = Shape::Kind::sphere;
    shape.radius_m = sphere->radius;
  } else if (const auto mesh = urdf::dynamic_pointer_cast<urdf::Mesh>(collision.geometry)) {
    shape.kind = Shape::Kind::mesh;
    shape.mesh = mesh->filename;
    shape.size_m = vector_of(mesh->scale);
  }
  return shape;
}

std::string size_fault(const Shape& shape) {
  if (shape.kind == Shape::Kind::box && !(shape.size_m.minCoeff() > 0)) return "a box with a side of 0 or less";
  if (shape.kind == Shape::Kind::cylinder && !(shape.radius_m > 0 && shape.length_m > 0))
    return "a cylinder with a radius or length of 0 or less";
  if (shape.kind == Shape::Kind::sphere && !(shape.radius_m > 0)) return "a sphere with a radius of 0 or less";
  return {};
}

std::vector<Shape> shapes_of(const urdf::Link& link, const std::string& file) {
  std::vector<Shape> shapes;
  for (const auto& collision : link.collision_array) {
    if (!collision || !collision->geometry) continue;
    shapes.push_back(shape_of(*collision));
    if (const std::string fault = size_fault(shapes.back()); !fault.empty())
      throw DescriptionError(fmt::format("{}: link \"{}\": its <collision> is {}", file, link.name, fault));
  }
  return shapes;
}

UrdfJoint joint_of(const urdf::Joint& joint, const Pose& X_FL, const std::string& file) {
  UrdfJoint out{.name = joint.name};
  out.kind = joint.type == urdf::Joint::FIXED        ? JointKind::fixed
             : joint.type == urdf::Joint::REVOLUTE   ? JointKind::revolute
             : joint.type == urdf::Joint::CONTINUOUS ? JointKind::continuous
                                                     : JointKind::other;
  if (out.kind == JointKind::revolute || out.kind == JointKind::continuous) {
    const Eigen::Vector3d axis = X_FL.q * vector_of(joint.axis);
    if (!(axis.norm() > 1e-6))
      throw DescriptionError(fmt::format("{}: joint \"{}\" has an axis of length 0", file, joint.name));
    out.axis_F = axis.normalized();
  }
  if (!joint.limits) return out;
  // huge limits are those of models that have none
  const auto said = [](double limit) { return limit > 0 && limit < 1e6 ? limit : 0; };
  out.effort = said(joint.limits->effort);
  out.velocity = said(joint.limits->velocity);
  out.lower_rad = joint.limits->lower;
  out.upper_rad = joint.limits->upper;
  if (out.kind == JointKind::revolute && out.lower_rad > out.upper_rad)
    throw DescriptionError(fmt::format("{}: joint \"{}\": its lower limit {} is above its upper limit {}", file,
                                       joint.name, out.lower_rad, out.upper_rad));
  return out;
}

// In L. The mass is not yet held against whether the link moves.
MassProperties mass_of(const urdf::Link& link, bool moves, const std::string& file,
                       std::vector<std::string>& warnings) {
  if (!link.inertial) return {};
  const urdf::Inertial& given = *link.inertial;
  const auto fail = [&](const std::string& what) {
    throw DescriptionError(fmt::format("{}: link \"{}\" {}", file, link.name, what));
  };
  if (given.mass < 0) fail(fmt::format("has a mass of {} kg: give what it weighs", given.mass));
  Eigen::Matrix3d I;
  I << given.ixx, given.ixy, given.ixz, given.ixy, given.iyy, given.iyz, given.ixz, given.iyz, given.izz;
  if (given.mass == 0) {
    if (!I.isZero(0))
      warnings.push_back(fmt::format("link \"{}\" has an inertia but no mass; it is left out", link.name));
    return {};
  }
  const Pose X_LI = pose_of(given.origin);
  if (I.isZero(0) && !moves) {
    warnings.push_back(fmt::format("link \"{}\" has a mass but no inertia; it counts as a point", link.name));
  } else if (const std::string fault = inertia_fault(I); !fault.empty()) {
    fail(fmt::format("has an inertia that no rigid body has: {}; take that of its box or cylinder", fault));
  }
  return moved({given.mass, Eigen::Vector3d::Zero(), I}, X_LI);
}

// A moving link needs a mass, its own or that of a link fixed to it.
void check_moving_masses(const UrdfModel& model) {
  std::vector<double> mass_kg(model.links.size(), 0);
  for (std::size_t i = model.links.size(); i-- > 0;) {
    const Link& link = model.links[i];
    mass_kg[i] += link.mass.mass_kg;
    if (link.parent == i) continue;
    if (!link.moves())
      mass_kg[link.parent] += mass_kg[i];
    else if (mass_kg[i] == 0 && link.joint.kind != JointKind::other)
      throw DescriptionError(
          fmt::format("{}: link \"{}\" moves by joint \"{}\", but has no mass; add an <inertial> with "
                      "mass and inertia, or make the joint fixed",
                      model.file, link.name, link.joint.name));
  }
}

void append_links(const urdf::ModelInterface& urdf, UrdfModel& model, std::vector<std::string>& warnings) {
  struct Open {
    urdf::LinkConstSharedPtr link;
    std::size_t parent;
  };
  std::vector<Open> open{{urdf.getRoot(), 0}};
  for (std::size_t next = 0; next < open.size(); ++next) {
    const urdf::Link& from = *open[next].link;
    const std::size_t parent = open[next].parent;
    Link link{.name = from.name, .parent = next == 0 ? 0 : parent, .joint = {}, .X_FL = {}, .mass = {}, .shapes = {}};
    if (next > 0) {
      link.X_FL = compose(model.links[parent].X_FL, pose_of(from.parent_joint->parent_to_joint_origin_transform));
      link.joint = joint_of(*from.parent_joint, link.X_FL, model.file);
    }
    link.mass = moved(mass_of(from, link.moves(), model.file, warnings), link.X_FL);
    link.shapes = shapes_of(from, model.file);
    model.links.push_back(std::move(link));
    for (const auto& child : from.child_links) open.push_back({child, next});
  }
}

// From the root's frame to that of the base.
void move_to_base(UrdfModel& model) {
  const auto base = std::ranges::find_if(
      model.links, [](const Link& link) { return link.name == "base_link" || link.name.ends_with("/base_link"); });
  model.base = base == model.links.end() ? model.links.front().name : base->name;
  if (base == model.links.end()) return;
  const Pose X_FR = inverse(base->X_FL);
  for (Link& link : model.links) {
    link.mass = moved(link.mass, X_FR);
    link.X_FL = compose(X_FR, link.X_FL);
    link.joint.axis_F = X_FR.q * link.joint.axis_F;
  }
}

}  // namespace

UrdfModel read_urdf(std::string_view xml, const std::string& file, std::vector<std::string>& warnings) {
  UrdfModel model;
  model.file = file;
  model.document = parse_xml(xml, file);
  check_structure(model.document, file);
  const urdf::ModelInterfaceSharedPtr urdf = by_liburdfdom(xml, file);
  model.name = urdf->getName();
  append_links(*urdf, model, warnings);
  move_to_base(model);
  check_moving_masses(model);
  return model;
}

}  // namespace kenaf::describe
