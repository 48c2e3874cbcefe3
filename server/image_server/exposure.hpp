// When pictures are taken, and what the world's thread then hands over.
//
// Cameras expose at whole multiples of 1 / rate of robot time, at the first step at or after them: so cameras with
// equal rates show the same moment, runs can be compared picture by picture, and a slow reader skips whole pictures.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "camera/snapshot.hpp"
#include "server/image_server/frame.hpp"
#include "server/world_server/simulation.hpp"

namespace kenaf::image_server {

// Number of a camera's picture: tick k is at k / rate.
using Tick = std::uint64_t;

// The last tick at or before a step, and the first step at or after a tick.
Tick tick_at(std::uint64_t step, double time_step_s, double rate_hz);
std::uint64_t step_of(Tick tick, double time_step_s, double rate_hz);

struct DueCamera {
  double rate_hz;
  std::optional<Tick> last;  // exposed; empty: none yet, so the next is due at once
};
// True if the camera exposes at this step. After a missed tick it waits for the next one.
bool exposes_at(const DueCamera& camera, std::uint64_t step, double time_step_s);
// Returns the first step, from `step` on, at which one of them exposes. `cameras` must not be empty.
std::uint64_t next_exposure(const std::vector<DueCamera>& cameras, std::uint64_t step, double time_step_s);

struct Exposure {
  camera::WorldSnapshot world;
  std::vector<std::vector<double>> field_of_view_rad;  // by robot of the snapshot and camera
  std::uint64_t step = 0;
  double time_step_s = 0;
  double speed = 0;  // times real time; 0: as fast as possible, or time is stopped
  SteadyTime wall;
  std::uint64_t asked = 0;  // the request that this answers
};

// Called on the world's thread: takes microseconds.
void expose(const world_server::Simulation& simulation, camera::SnapshotTaker& taker, Exposure& out);

}  // namespace kenaf::image_server
