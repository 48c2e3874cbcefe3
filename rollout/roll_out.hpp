// Drives one robot through one manoeuvre in a world of its own, as fast as it goes, and records it.
//
// Deterministic: the same arguments give the same bits, on any number of threads.
// Thread safety: pure functions; any number at once.
#pragma once

#include <cstdint>
#include <string>

#include "physics/world.hpp"
#include "rollout/manoeuvre.hpp"
#include "runs/run_file.hpp"

namespace kenaf::rollout {

struct RollOutOptions {
  physics::PhysicsSettings physics;
  std::uint64_t seed = 1;
  double sample_period_s = 0.01;  // of the recorded rows, and of the commands
  double noise_scale = 1;         // of the robot's sensor noise; 0: exact
};

struct RollOut {
  runs::Run run;           // columns of docs/run-format.md
  bool succeeded = false;  // by the manoeuvre's own measure; false without one
  std::string fault;       // why the simulation was ended early; empty: it was not
  physics::RobotTruth end{};
  double contacts_per_step = 0;
  std::uint64_t steps = 0;
};

// `world` is taken with the terrain effects of `robot`.
RollOut roll_out(const physics::RobotDescription& robot, const physics::WorldDescription& world,
                 const Manoeuvre& manoeuvre, const RollOutOptions& options);

}  // namespace kenaf::rollout
