#include "gap/diagnose/observation.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace kenaf::gap {
namespace {

constexpr double kMoves_mps = 1e-6, kShortest_s = 0.5;

// Rows until the robot is told to move.
std::size_t resting_rows(const rollout::Manoeuvre& replay) {
  const auto moves = [&](const rollout::TimedCommand& timed) {
    for (const double speed_mps : timed.command.track_speed_mps)
      if (std::abs(speed_mps) > kMoves_mps) return true;
    for (std::size_t i = 0; i < timed.command.flipper.size(); ++i)
      if (timed.command.flipper[i].value != replay.timed.front().command.flipper[i].value) return true;
    return false;
  };
  std::size_t rows = 0;
  while (rows < replay.timed.size() && !moves(replay.timed[rows])) ++rows;
  return rows;
}

double mean_of_first(std::span<const double> column, std::size_t rows, double otherwise) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < std::min(rows, column.size()); ++i)
    if (!std::isnan(column[i])) sum += column[i], ++count;
  return count > 0 ? sum / count : otherwise;
}

// A log's single first pose has the whole noise of its sensor; the rows before the first order have less together.
void start_at_mean(Observation& observation) {
  rollout::Start& start = *observation.replay.start;
  const std::size_t rows = observation.resting_rows;
  start.x_m = mean_of_first(observation.run.column("x_m"), rows, start.x_m);
  start.y_m = mean_of_first(observation.run.column("y_m"), rows, start.y_m);
  start.yaw_rad = mean_of_first(observation.run.column("yaw_rad"), rows, start.yaw_rad);
}

}  // namespace

Observations observe(const std::filesystem::path& folder, const std::string& robot, const std::string& world) {
  Observations result;
  result.dataset = runs::read_dataset(folder);
  result.robot_name = robot.empty() ? runs::resolve_beside(folder, result.dataset.robot, ".toml") : robot;
  result.robot = physics::load_robot(result.robot_name);
  std::map<std::string, std::size_t> worlds;
  for (const runs::DatasetRun& entry : result.dataset.runs) {
    Observation observation{entry.file, entry.manoeuvre, 0, {}, {}, 0};
    try {
      observation.run = runs::read_run(folder / entry.file);
      observation.replay = rollout::replay_of(observation.run, entry.file);
    } catch (const runs::RunFileError& error) {
      result.warnings.push_back(error.what());
      continue;
    }
    if (observation.replay.at_most_s() < kShortest_s) {
      result.warnings.push_back(fmt::format("{}: lasts less than {} s; left out", entry.file, kShortest_s));
      continue;
    }
    const std::string name =
        !world.empty() ? world
                       : runs::resolve_beside(folder, entry.world.empty() ? result.dataset.world : entry.world, ".sdf");
    const auto [known, is_new] = worlds.try_emplace(name, result.worlds.size());
    if (is_new) result.worlds.push_back(physics::load_world(name, result.warnings));
    observation.world = known->second;
    observation.resting_rows = resting_rows(observation.replay);
    start_at_mean(observation);
    result.runs.push_back(std::move(observation));
  }
  if (result.runs.empty())
    throw runs::RunFileError(fmt::format("{}: none of its {} runs can be used{}", folder.string(),
                                         result.dataset.runs.size(),
                                         result.warnings.empty() ? "" : "; the first one: " + result.warnings.front()));
  return result;
}

}  // namespace kenaf::gap
