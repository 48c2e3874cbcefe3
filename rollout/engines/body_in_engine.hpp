// A run whose body is moved by another physics engine: belts and flippers turn as Kenaf's drives turn them, and the
// other engine computes where that takes the robot. For data of a "reality" that differs from the model in ways that no
// effect names.
//
// Whoever makes such runs leaves out what the engines cannot do alike: ODE and MuJoCo do not hold a turn on the spot as
// belts with friction ellipses do, and have no meshes here; effects of sensors act on Kenaf's body only
// (shows_in_engine()).
//
// Thread safety: pure functions; any number at once.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "formats/runs/run_file.hpp"
#include "physics/effects.hpp"
#include "physics/robot_description.hpp"
#include "physics/world_description.hpp"

namespace kenaf::engines {

// Names of the engines that this was built with: "mujoco", "ode". Empty if their libraries were missing.
std::vector<std::string> engine_names();

// Whether a run with an engine's body shows the effect: effects of commands and drives, of the body's mass and centre,
// and of the ground's slope and obstacles; among those of contacts only the friction along, as these engines have one
// for both directions.
bool shows_in_engine(const physics::EffectInfo& effect);

// `exact`: a run of roll_out() without noise; `noisy`: the same with noise, from the same start. Returns `noisy` with
// the engine's position, tilt, yaw and turn rates with the same noise on them, and without accelerations. The robot's
// effects are applied to robot and world. Throws std::invalid_argument if there is no such engine, if the run lacks
// belts, pose or tilt, or if planes and boxes differ in friction and the engine is "mujoco", which has one friction for
// all ground.
runs::Run with_body_of(std::string_view engine, const physics::RobotDescription& robot,
                       const physics::WorldDescription& world, const runs::Run& exact, const runs::Run& noisy);

}  // namespace kenaf::engines
