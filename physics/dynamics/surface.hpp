// Surface properties for the contact solver: friction, and the belt that runs over a surface.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/contact_point.hpp"

namespace kenaf::physics {

// A track's belt: one degree of freedom in addition to the rigid bodies. Its speed is a state of the simulation, solved
// together with the contacts: the motor drives it, the friction on all the surfaces it runs over brakes it.
struct Belt {
  // set before a step
  double moving_mass_kg = 1;      // infinite: a prescribed speed, whatever pushes on it
  double target_mps = 0;          // the motor's set speed
  double droop_mpspns = 0;        // shortfall from it for each newton second that the motor gives within a step
  double min_impulse_ns = 0;      // limits of the motor within a step, <= 0
  double max_impulse_ns = 0;      // >= 0
  double dry_friction_ns = 0;     // of the running gear, within a step
  double viscous_nspm = 0;        // of the running gear
  double rolling_resistance = 0;  // friction force for a unit of normal force on the belt
  double slip_spm = 0;            // the surface moves with speed (1 - slip |speed|)
  // state
  double speed_mps = 0;  // of the surface relative to the body, + drives the robot forward
  // results of a step
  double motor_impulse_ns = 0;
  double friction_impulse_ns = 0;  // dry and rolling, of the running gear
  double viscous_impulse_ns = 0;
  double load_ns = 0;           // normal impulse on it
  double warm_start_share = 1;  // of the last step's impulses that the next step starts from, normal ones apart
};

struct Surface {
  double friction_along = 1;
  double friction_across = 1;  // equal to `friction_along` without a belt
  Belt* belt = nullptr;        // null: the surface does not move in its body
  double axis_y = 1;           // the belt turns about (0, axis_y, 0) of its body, 1 or -1
  double lug_height_m = 0;
  double shear_deformation_m = 0;  // K of shear.hpp, of a belt
  double compliance_scale = 1;     // of the compliance of the ground under it
  double damping_scale = 1;
  TouchingPart part = TouchingPart::body;  // of a robot; nothing else has one
};

// Stored at btCollisionObject::getUserPointer().
struct Collider {
  std::vector<Surface> surfaces;  // of each child of a compound shape, or the only one
  std::uint32_t robot = 0;        // 0: none
};

}  // namespace kenaf::physics
