// Drives one robot through one manoeuvre in a world of its own, as fast as it goes, and records it.
//
// Deterministic: the same arguments give the same bits, on any number of threads.
// Thread safety: pure functions; any number at once.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "formats/runs/run_file.hpp"
#include "physics/world.hpp"
#include "rollout/manoeuvre.hpp"

namespace kenaf::rollout {

// 1 sigma of start poses where a robot is put down by hand. Chosen.
inline constexpr double kUsualScatter_m = 0.005, kUsualScatter_rad = 0.01;

struct RollOutOptions {
  physics::PhysicsSettings physics;
  std::uint64_t seed = 1;
  double sample_period_s = 0.01;  // of the recorded rows, and of the commands; a multiple of the time step
  double noise_scale = 1;         // of all noise and bias; 0: exact
  // Motion capture is no sensor of the robot. Chosen: a good one.
  double mocap_noise_m = 0.001, mocap_noise_rad = 0.002;
  // 1 sigma of the start pose, as nobody puts a robot twice at the same place; not for replays.
  double start_scatter_m = 0, start_scatter_rad = 0;
};

struct RollOut {
  runs::Run run;           // columns of docs/run-format.md
  bool succeeded = false;  // by the manoeuvre's own measure; false without one
  bool gave_up = false;    // the operator did (Phase::give_up)
  std::string fault;       // why the simulation was ended early, as World::fault() says it; empty: it was not
  physics::RobotTruth end{};
  std::vector<double> phase_began_s;  // of each phase that was reached; of one passed over: of the next
  double contacts_per_step = 0;
  std::uint64_t steps = 0;  // with those in which the robot settled before the first row
};

// Robot and ground are taken with the effects of `robot`. The robot stands still at the start, with its flippers where
// the first phase wants them; what it is told for t_s >= 0 is recorded. Position and yaw are from motion capture, roll
// and pitch from the posture sensor (INS), the rest from IMU, Encoder, Tachometer and Drives; a sensor that the
// robot does not have leaves its columns out, one that is slower than the rows leaves cells empty.
// Throws std::invalid_argument where options do not fit together or the manoeuvre moves no robot.
RollOut roll_out(const physics::RobotDescription& robot, const physics::WorldDescription& world,
                 const Manoeuvre& manoeuvre, const RollOutOptions& options);

// White noise of the columns that have one, 1 sigma, in their units: as a dataset states it.
std::map<std::string, double> column_noise(const physics::RobotDescription& robot, const RollOutOptions& options);

// The columns of a run of this robot: what its sensors measure, and what of it is commanded.
std::vector<std::string> recorded_columns(const physics::RobotDescription& robot);

}  // namespace kenaf::rollout
