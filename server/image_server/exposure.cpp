#include "server/image_server/exposure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kenaf::image_server {

namespace {

// In steps: above the rounding error of a product, below any relevant difference.
constexpr double kRounding = 1e-6;

}  // namespace

Tick tick_at(std::uint64_t step, double time_step_s, double rate_hz) {
  return static_cast<Tick>(std::floor((static_cast<double>(step) + kRounding) * (time_step_s * rate_hz)));
}

std::uint64_t step_of(Tick tick, double time_step_s, double rate_hz) {
  return static_cast<std::uint64_t>(
      std::ceil(std::max(0.0, static_cast<double>(tick) / (time_step_s * rate_hz) - kRounding)));
}

bool exposes_at(const DueCamera& camera, std::uint64_t step, double time_step_s) {
  if (!camera.last) return true;
  const Tick tick = tick_at(step, time_step_s, camera.rate_hz);
  // a tick is shorter than a step if the time step is long and the rate high
  return tick != *camera.last && step_of(tick, time_step_s, camera.rate_hz) == step;
}

std::uint64_t next_exposure(const std::vector<DueCamera>& cameras, std::uint64_t step, double time_step_s) {
  std::uint64_t first = std::numeric_limits<std::uint64_t>::max();
  for (const DueCamera& camera : cameras) {
    if (exposes_at(camera, step, time_step_s)) return step;
    const Tick next = tick_at(step, time_step_s, camera.rate_hz) + 1;
    first = std::min(first, std::max(step + 1, step_of(next, time_step_s, camera.rate_hz)));
  }
  return first;
}

void expose(const world_server::Simulation& simulation, camera::SnapshotTaker& taker, Exposure& out) {
  taker.take(simulation.world, out.world);
  out.field_of_view_rad.resize(out.world.robots.size());
  for (std::size_t i = 0; i < out.world.robots.size(); ++i) {
    const physics::RobotId id = out.world.robots[i].id;
    const auto session = std::ranges::find_if(
        simulation.sessions, [id](const auto& candidate) { return candidate->robot && candidate->robot->id == id; });
    if (session != simulation.sessions.end()) {
      out.field_of_view_rad[i] = (*session)->robot->camera_field_of_view_rad;
    } else {
      out.field_of_view_rad[i] = world_server::Simulation::unzoomed(*out.world.robots[i].description);
    }
  }
  out.step = simulation.world.step_count();
  out.time_step_s = simulation.world.settings().time_step_s;
  out.speed = simulation.clock.paused() ? 0 : simulation.clock.speed();
  out.wall = std::chrono::steady_clock::now();
}

}  // namespace kenaf::image_server
