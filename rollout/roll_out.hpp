// Drives one robot through one manoeuvre in a world of its own, as fast as possible, and records it.
//
// Deterministic: the same arguments give the same bits, on any number of threads.
// Thread safety: pure functions; any number at once.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "formats/runs/run_file.hpp"
#include "physics/world.hpp"
#include "rollout/manoeuvre.hpp"

namespace kenaf::rollout {

// Sigma of start poses of a robot that is placed by hand. Chosen.
inline constexpr double kUsualScatter_m = 0.005, kUsualScatter_rad = 0.01;

struct RollOutOptions {
  physics::PhysicsSettings physics;
  std::uint64_t seed = 1;
  double sample_period_s = 0.01;  // of the recorded rows, and of the commands; a multiple of the time step
  double noise_scale = 1;         // of all noise and bias; 0: exact
  // Noise of motion capture, which is no sensor of the robot. Chosen: a good one.
  double mocap_noise_m = 0.001, mocap_noise_rad = 0.002;
  // Sigma of the start pose, as no robot is placed twice at exactly the same pose; not for replays.
  double start_scatter_m = 0, start_scatter_rad = 0;
};

// Start poses of a robot that is placed by hand, `scale` times as far apart as usual; 0: all the same.
inline void scatter_starts(RollOutOptions& options, double scale) {
  options.start_scatter_m = kUsualScatter_m * scale;
  options.start_scatter_rad = kUsualScatter_rad * scale;
}

struct RollOut {
  runs::Run run;           // columns of docs/logs.md
  bool succeeded = false;  // by the manoeuvre's own criterion; false without one
  bool gave_up = false;    // the operator did (Phase::give_up)
  std::string fault;       // World::fault(), if it ended the simulation early; else empty
  physics::RobotTruth end{};
  std::vector<double> phase_began_s;  // of each phase that was reached; a skipped one has the time of the next
  double contacts_per_step = 0;
  std::uint64_t steps = 0;  // including those in which the robot settled before the first row
};

// The effects of `robot` apply to robot and ground. The robot stands still at the start, with its flippers where the
// first phase has them; its commands are recorded from t_s = 0 on. Position and yaw come from motion capture, roll and
// pitch from the orientation sensor (INS), the rest from IMU, Encoder, Tachometer and Drives. Columns of a sensor that
// the robot does not have are omitted; a sensor slower than the rows leaves cells empty. Throws std::invalid_argument
// if the options are inconsistent or the manoeuvre has neither phases nor commands.
RollOut roll_out(const physics::RobotDescription& robot, const physics::WorldDescription& world,
                 const Manoeuvre& manoeuvre, const RollOutOptions& options);

// One drive, as several robots report it that move alike in it (moves_alike.hpp): simulated once, with the bits that
// roll_out() gives for each. They differ in RollOut::run alone. Throws as roll_out() does, and std::invalid_argument if
// there are no robots.
std::vector<RollOut> roll_outs(std::span<const physics::RobotDescription> robots,
                               const physics::WorldDescription& world, const Manoeuvre& manoeuvre,
                               const RollOutOptions& options);

// Sigma of the white noise of columns, in their units, as a dataset states it; without columns that have none.
std::map<std::string, double> column_noise(const physics::RobotDescription& robot, const RollOutOptions& options);

// The columns of a run of this robot: those that its sensors measure, and its commands.
std::vector<std::string> recorded_columns(const physics::RobotDescription& robot);

}  // namespace kenaf::rollout
