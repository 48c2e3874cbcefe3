// The engines of the comparison: Kenaf's own physics beside those of rollout/engines/.
//
// Settings of the other engines:
//  - Robot: Kenaf's masses, inertias, hinges, torque limits. A track is two cylinders and a row of three boxes: 32
//    contacts on level ground (Kenaf: 28); a flipper is two cylinders and a box. "1 box a belly" (16 contacts) and
//    "meshes" (a convex hull a belt, 5 to 6 contacts) are faster, without a limit: a few points are not a track.
//  - Belts: a given surface speed with the lag of Kenaf's drives, without motor or force limit. ODE: dContactMotion1.
//    MuJoCo has none: between mj_step1 and mj_step2 the belt's part is added to the slip that its friction rows work
//    against.
//  - Friction: in ODE a pyramid, which holds a robot that should turn in place; in MuJoCo one coefficient, elliptic or
//    pyramidal cones. In MuJoCo's convex contact model a slipping surface lifts off, so a turning robot rests on a few
//    points.
//  - Contacts: in ODE Kenaf's stiffness and damping, in MuJoCo its defaults.
//  - Solvers: MuJoCo's Newton and CG by default settings, PGS with 20 iterations (its default of 100 is slower); ODE's
//    QuickStep with 10, 20 (default) and 50 iterations, and WorldStep.
#pragma once

#include <vector>

#include "rollout/engines/runner.hpp"

namespace kenaf::bench {

using engines::Engine;
using engines::EngineScene;
using engines::Runner;

std::vector<Engine> kenaf_engines();  // without sensors, with

}  // namespace kenaf::bench
