// A run whose body another physics engine moves: its belts and flippers turn as Kenaf's drives turn them, and where
// that takes the robot the other engine says. For data of a "reality" that differs from the model in what nobody can
// name.
//
// What the engines cannot do alike is left out by who makes such runs: ODE and MuJoCo do not hold a turn on the spot as
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

// Of the engines that this was built with: "mujoco", "ode". None where their libraries were not there.
std::vector<std::string> engine_names();

// Whether a run whose body an engine moves shows the effect: those of commands and drives, of the body's mass and
// centre, and of the ground's slope and obstacles; of contacts the friction along alone, as these engines have one for
// both directions.
bool shows_in_engine(const physics::EffectInfo& effect);

// `exact`: a run of roll_out() without noise; `noisy`: the same with noise, from the same start. Returns `noisy` with
// position, tilt, yaw and turn rates as the engine has them and the same noise on them, and without accelerations.
// Robot and world are taken with the robot's effects. Throws std::invalid_argument where there is no such engine, or
// the run lacks belts, pose or tilt.
runs::Run with_body_of(std::string_view engine, const physics::RobotDescription& robot,
                       const physics::WorldDescription& world, const runs::Run& exact, const runs::Run& noisy);

}  // namespace kenaf::engines
