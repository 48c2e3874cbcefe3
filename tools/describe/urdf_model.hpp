// A URDF as plain values: read by liburdfdom, its joints at 0, all places in one frame.
//
// Frame F: origin and axes of the link "base_link" or ".../base_link", or of the root if there is none; x forward, y
// left, z up (REP 103). Frame L: a link's. SI units, radians.
//
// Thread safety: reading sets console_bridge's output handler for the whole process while it runs, so one thread at a
// time reads.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "physics/pose.hpp"
#include "tools/describe/mass_properties.hpp"
#include "tools/describe/xml_tree.hpp"

namespace kenaf::describe {

struct Shape {
  enum class Kind { box, cylinder, sphere, mesh } kind;
  Eigen::Vector3d size_m;     // of a box; of a mesh, its scale
  double radius_m, length_m;  // of a cylinder along its own z; of a sphere, its radius
  std::string mesh;           // its URI
  physics::Pose X_LS;
};

enum class JointKind { fixed, revolute, continuous, other };

// The joint that leads to a link.
struct UrdfJoint {
  std::string name;
  JointKind kind = JointKind::fixed;
  Eigen::Vector3d axis_F{Eigen::Vector3d::UnitX()};  // of length 1
  double lower_rad = 0, upper_rad = 0;               // of a revolute one
  double effort = 0, velocity = 0;                   // N m and rad/s; 0: not said
};

struct Link {
  std::string name;
  std::size_t parent;  // index; its own: the root
  UrdfJoint joint;
  physics::Pose X_FL;
  MassProperties mass;  // in F; mass 0: none
  std::vector<Shape> shapes;

  bool moves() const { return joint.kind != JointKind::fixed; }  // against its parent
};

struct UrdfModel {
  std::string name, file;
  std::string base;         // the link whose frame F is
  std::vector<Link> links;  // parents before children
  XmlNode document;         // also has what liburdfdom leaves out
};

// Throws DescriptionError with `file` and the link or joint at fault: what check_structure() finds; what liburdfdom
// refuses; an axis of length 0; a mass that is negative, or missing on a link that moves with all that is fixed to it;
// an inertia that no rigid body has. A mass without any inertia, of a fixed link, is a point mass. `warnings` gets what
// is left out.
UrdfModel read_urdf(std::string_view xml, const std::string& file, std::vector<std::string>& warnings);

}  // namespace kenaf::describe
