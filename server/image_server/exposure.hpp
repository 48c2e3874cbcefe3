// The moment at which pictures are taken: when it falls due, and what the world's thread then hands over.
//
// Cameras of a rate expose at whole multiples of 1 / rate of robot time, at the first step at or after them: so cameras
// of one rate show the same moment, runs can be compared picture by picture, and who falls behind leaves out whole
// pictures.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "camera/snapshot.hpp"
#include "server/image_server/frame.hpp"
#include "server/world_server/simulation.hpp"

namespace kenaf::image_server {

// Which picture of a camera's it is: tick k is at k / rate.
using Tick = std::uint64_t;

// The last tick at or before a step, and the first step at or after a tick.
Tick tick_at(std::uint64_t step, double time_step_s, double rate_hz);
std::uint64_t step_of(Tick tick, double time_step_s, double rate_hz);

struct DueCamera {
  double rate_hz;
  std::optional<Tick> last;  // exposed; empty: none yet, so the next falls due at once
};
// Whether it exposes at this step. After a tick that was missed it waits for the next one.
bool exposes_at(const DueCamera& camera, std::uint64_t step, double time_step_s);
// The first step, from `step` on, at which one of them exposes. `cameras` must not be empty.
std::uint64_t next_exposure(const std::vector<DueCamera>& cameras, std::uint64_t step, double time_step_s);

struct Exposure {
  camera::WorldSnapshot world;
  std::vector<std::vector<double>> field_of_view_rad;  // of each robot of the snapshot, each camera
  std::uint64_t step = 0;
  double time_step_s = 0;
  double speed = 0;  // times real time; 0: as fast as it goes, or time stands still
  SteadyTime wall;
  std::uint64_t asked = 0;  // which request this answers
};

// On the world's thread: microseconds.
void expose(const world_server::Simulation& simulation, camera::SnapshotTaker& taker, Exposure& out);

}  // namespace kenaf::image_server
