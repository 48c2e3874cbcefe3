// Friction that builds up as a belt shears the ground, or its own rubber, under it: Janosi and Hanamoto, "The
// analytical determination of drawbar pull as a function of slip for tracked vehicles in deformable soils", 1961; Wong,
// Theory of Ground Vehicles, 2.4.
//
// A piece of a belt of speed u (m/s) enters the ground at the front of the stretch on which the belt's run is pressed
// down. At the distance x (m) behind that place it has been there for x / |u|, and with a slip s (m/s) it has sheared
// by
//   j = |s| x / |u|
// and holds the share 1 - exp(-j / K) of its friction, against the slip. A contact point stands for a stretch of the
// run and has the mean share over it, so that under an even load the points' sum is the integral over the contact
// length, whatever their number. j takes slip and speed as they are now; it does not remember a change of them.
//
// The share is 1, Coulomb's friction, where nothing builds up: K = 0; a belt that stands; and where no length of
// contact is known: wheels, a belt that is pressed down at one place along its run, the arcs at its ends, edges and
// corners of the ground.
//
// Thread safety: pure functions and values.
#pragma once

#include <span>

#include "physics/dynamics/bullet.hpp"

namespace kenaf::physics {

struct BeltPair;
struct BeltShape;
struct BeltTouch;

// The part of a belt's run that a contact point stands for, by how far a slip shears at its two ends: j / (K s), s/m,
// which is x / (K |u|). 0 <= from < to; to = 0: there is no such part, the point has all of its friction.
struct ShearStretch {
  btScalar from = 0, to = 0;
};

// The first and the last place (BeltTouch::run_place) of a run that is pressed into the ground. first > last: none.
struct PressedRun {
  int first = 1, last = 0;
};

// How a belt shears what it stands on.
struct Shearing {
  btScalar rate = 0;     // 1 / (K |u|), s/m²; 0: friction does not build up
  bool forward = false;  // the surface of the lower run moves towards disc 0, that of the upper one towards disc 1
  PressedRun lower, upper;
};
// `pairs`: all of the world; those of other belts are passed over.
Shearing shearing_of(const BeltShape& belt, std::span<BeltPair* const> pairs);

// Requires shearing.rate > 0.
ShearStretch stretch_of(const BeltShape& belt, const BeltTouch& touch, const Shearing& shearing);

// The share of its friction that a stretch holds, divided by the slip (s/m). Finite at a slip of 0. Requires
// stretch.to > 0, slip_mps >= 0.
btScalar sheared_share_per_slip(const ShearStretch& stretch, btScalar slip_mps);

}  // namespace kenaf::physics
