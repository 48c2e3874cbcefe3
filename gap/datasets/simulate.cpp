#include "gap/datasets/simulate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "formats/runs/dataset.hpp"
#include "gap/datasets/dataset_files.hpp"
#include "gap/datasets/physics_settings.hpp"
#include "gap/parallel.hpp"
#include "physics/world_description.hpp"
#include "rollout/roll_out.hpp"

namespace kenaf::gap::datasets {
namespace {

constexpr int kMostRuns = 100000;

std::string description_of(const SimulationRequest& request) {
  std::string text = "Simulated.";
  if (!request.effects.empty()) text += fmt::format(" Effects: {}.", fmt::join(request.effects, " "));
  return text + fmt::format(" Physics: {}. Noise {}, start scatter {}, seed {}.", physics_text(request.physics),
                            request.noise_scale, request.scatter_scale, request.seed);
}

struct Asked {
  std::string argument;
  rollout::Manoeuvre manoeuvre;
  const physics::WorldDescription* world;
};

}  // namespace

// FNV-1a hash (http://www.isthe.com/chongo/tech/comp/fnv/) of everything that a run's noise depends on.
std::uint64_t seed_of_run(std::uint64_t seed, std::string_view manoeuvre, int repeat) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : fmt::format("{} {} {}", seed, repeat, manoeuvre))
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

SimulatedDataset simulate_dataset(const SimulationRequest& request) {
  // Checks the request.
  if (request.manoeuvres.empty()) throw std::invalid_argument("no manoeuvre is given; kenaf-gap manoeuvres lists them");
  if (request.repeats < 1 || std::ssize(request.manoeuvres) > kMostRuns / request.repeats)
    throw std::invalid_argument(fmt::format("repeats must be at least 1, and all runs together at most {}", kMostRuns));
  for (const double scale : {request.noise_scale, request.scatter_scale})
    if (!(scale >= 0 && scale <= kLargestScale))
      throw std::invalid_argument(fmt::format("noise and scatter must be from 0 to {}", kLargestScale));

  // The robot with its effects; the stated noise is that of the nominal one.
  const physics::RobotDescription nominal = physics::load_robot(request.robot);
  physics::RobotDescription robot = nominal;
  for (const std::string& effect : request.effects) physics::set_effect(robot.effects, effect);

  rollout::RollOutOptions options;
  options.physics = request.physics;
  options.noise_scale = request.noise_scale;
  rollout::scatter_starts(options, request.scatter_scale);

  // The manoeuvres with their worlds, each world loaded once. The map does not move its elements.
  SimulatedDataset result;
  std::map<std::string, physics::WorldDescription> worlds;
  std::vector<Asked> asked;
  for (const std::string& name : request.manoeuvres) {
    rollout::Manoeuvre manoeuvre = rollout::load_manoeuvre(name);
    if (!request.world.empty()) manoeuvre.world = request.world;
    if (manoeuvre.world.empty())
      throw std::invalid_argument(fmt::format("{}: does not name its world; give --world", name));
    const auto [world, is_new] = worlds.try_emplace(manoeuvre.world);
    if (is_new) world->second = physics::load_world(manoeuvre.world, result.warnings);
    asked.push_back({name, std::move(manoeuvre), &world->second});
  }

  // The dataset's table of runs, with copies of the descriptions that are files.
  PartFolder folder(request.out, request.force, ", or --force to write into it");
  Descriptions robots(folder.path(), ".toml"), world_files(folder.path(), ".sdf");
  runs::Dataset dataset{.source = "sim",
                        .robot = robots.add(request.robot),
                        .world = world_files.add(asked.front().manoeuvre.world),
                        .description = description_of(request),
                        .noise = rollout::column_noise(nominal, options),
                        .runs = {}};
  const auto repeats = static_cast<std::size_t>(request.repeats);
  for (std::size_t i = 0; i < asked.size() * repeats; ++i) {
    const rollout::Manoeuvre& manoeuvre = asked[i / repeats].manoeuvre;
    const std::string world = world_files.add(manoeuvre.world);
    dataset.runs.push_back(
        {runs::numbered_run_file(i), manoeuvre.name, world == dataset.world ? std::string() : world});
  }

  // Each run has its own seed and its own elements to write, so that the jobs are independent.
  result.runs.resize(dataset.runs.size());
  for_each_job(dataset.runs.size(), request.jobs, [&](std::size_t i) {
    const Asked& of = asked[i / repeats];
    rollout::RollOutOptions own = options;
    own.seed = seed_of_run(request.seed, of.argument, static_cast<int>(i % repeats));
    const rollout::RollOut out = rollout::roll_out(robot, *of.world, of.manoeuvre, own);
    runs::write_run(folder.path() / dataset.runs[i].file, out.run);
    SimulatedRun& run = result.runs[i];
    run = {.file = dataset.runs[i].file,
           .manoeuvre = of.manoeuvre.name,
           .duration_s = out.run.column("t_s").back(),
           .succeeded = of.manoeuvre.success ? std::optional(out.succeeded) : std::nullopt,
           .gave_up = out.gave_up,
           .fault = out.fault};
    dataset.runs[i].fault = out.fault;
  });

  runs::write_dataset(folder.path(), dataset);
  folder.finish();
  return result;
}

}  // namespace kenaf::gap::datasets
