// Simulations, and the names of what can be simulated.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "formats/description/data_files.hpp"
#include "gap/candidates/candidate.hpp"
#include "gap/datasets/physics_settings.hpp"
#include "gap/datasets/simulate.hpp"
#include "gap/parallel.hpp"
#include "physics/effects.hpp"
#include "physics/world_description.hpp"
#include "python/core.hpp"
#include "python/interruptible.hpp"
#include "python/robot_values.hpp"
#include "python/run_arrays.hpp"
#include "rollout/roll_out.hpp"

namespace kenaf::python {
namespace py = pybind11;
namespace {

using physics::RobotDescription;
using physics::WorldDescription;
using rollout::Manoeuvre;

// What many simulations share is loaded once.
template <typename T>
class Shared {
 public:
  std::shared_ptr<const T> get(const std::string& name, const auto& load) {
    std::shared_ptr<const T>& kept = by_name_[name];
    if (!kept) kept = std::make_shared<const T>(load(name));
    return kept;
  }

 private:
  std::map<std::string, std::shared_ptr<const T>> by_name_;
};

struct Loaded {
  Shared<RobotDescription> robots;
  Shared<WorldDescription> worlds;
  Shared<Manoeuvre> manoeuvres;
};

struct Simulation {
  RobotDescription robot;
  std::shared_ptr<const WorldDescription> world;
  std::shared_ptr<const Manoeuvre> manoeuvre;
  rollout::RollOutOptions options;
};

WorldDescription load_world(const std::string& name) {
  std::vector<std::string> unsupported;
  WorldDescription world = physics::load_world(name, unsupported);
  for (const std::string& text : unsupported)
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
  return world;
}

// `commands`: (times of shape (n,), track speeds (n, 2), flipper angles (n, 4) or None).
Manoeuvre manoeuvre_of(const py::tuple& commands) {
  const Array t_s = array_of(commands[0], {-1}, "t_s");
  const py::ssize_t count = t_s.shape(0);
  const Array tracks = array_of(commands[1], {count, robot::kTrackCount}, "track_mps");
  const bool has_flippers = !commands[2].is_none();
  const Array flippers = has_flippers ? array_of(commands[2], {count, robot::kFlipperCount}, "flipper_rad") : Array();
  Manoeuvre manoeuvre;
  for (py::ssize_t i = 0; i < count; ++i) {
    rollout::TimedCommand timed{.t_s = t_s.at(i), .command = {}};
    for (std::size_t k = 0; k < robot::kTrackCount; ++k) timed.command.track_speed_mps[k] = tracks.at(i, k);
    for (std::size_t k = 0; has_flippers && k < robot::kFlipperCount; ++k)
      timed.command.flipper[k] = {robot::JointMode::angle, flippers.at(i, k)};
    manoeuvre.timed.push_back(timed);
  }
  return manoeuvre;
}

std::shared_ptr<const Manoeuvre> manoeuvre_asked(const py::dict& asked, Loaded& loaded) {
  const py::object name = asked["manoeuvre"];
  if (!name.is_none()) return loaded.manoeuvres.get(name.cast<std::string>(), rollout::load_manoeuvre);
  const py::object run = asked["run"];
  return std::make_shared<const Manoeuvre>(run.is_none() ? manoeuvre_of(asked["commands"])
                                                         : rollout::replay_of(run_of(run), "the run"));
}

double in_range(const py::dict& asked, const char* key, double min, double max) {
  const auto value = asked[key].cast<double>();
  if (!(value >= min && value <= max))
    throw std::invalid_argument(fmt::format("{}: {} is out of range; it goes from {} to {}", key, value, min, max));
  return value;
}

Simulation simulation_of(const py::dict& asked, Loaded& loaded) {
  Simulation simulation;
  const auto nominal = loaded.robots.get(asked["robot"].cast<std::string>(), physics::load_robot);
  simulation.robot = robot_with(*nominal, asked["values"].cast<Values>());
  simulation.manoeuvre = manoeuvre_asked(asked, loaded);

  auto world = asked["world"].cast<std::string>();
  if (world.empty()) world = simulation.manoeuvre->world;
  if (world.empty()) throw std::invalid_argument("world: the manoeuvre does not name its world; name one");
  simulation.world = loaded.worlds.get(world, load_world);

  rollout::RollOutOptions& options = simulation.options;
  for (const auto& [key, value] : asked["physics"].cast<std::map<std::string, double>>())
    gap::datasets::set_physics(options.physics, fmt::format("{}={}", key, value));
  options.seed = gap::datasets::seed_of_run(asked["seed"].cast<std::uint64_t>(), asked["name"].cast<std::string>(),
                                            asked["repeat"].cast<int>());
  options.noise_scale = in_range(asked, "noise", 0, gap::datasets::kLargestScale);
  rollout::scatter_starts(options, in_range(asked, "scatter", 0, gap::datasets::kLargestScale));
  options.sample_period_s = in_range(asked, "sample_period_s", options.physics.time_step_s, 1);
  return simulation;
}

// Leaves only the named columns; an empty list leaves all.
void keep_columns(runs::Run& run, const std::vector<std::string>& names) {
  if (names.empty()) return;
  runs::Run kept;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(run.columns, name);
    if (found == run.columns.end())
      throw std::invalid_argument(fmt::format("columns: a run of this robot has no {}", name));
    kept.columns.push_back(name);
    kept.values.push_back(run.values[static_cast<std::size_t>(found - run.columns.begin())]);
  }
  run = std::move(kept);
}

py::dict result_of(rollout::RollOut&& out, const Simulation& simulation) {
  py::dict result;
  result["columns"] = arrays_of(std::move(out.run));
  result["world"] = simulation.world->name;
  result["succeeded"] = simulation.manoeuvre->success ? py::object(py::bool_(out.succeeded)) : py::none();
  result["gave_up"] = out.gave_up;
  result["fault"] = out.fault;
  result["phase_began_s"] = array_from(out.phase_began_s);
  return result;
}

// `asked`: dicts with the members of kenaf.Simulation. `progress`: None or a function of the number of finished ones.
py::list simulate(const py::list& asked, unsigned jobs, const std::vector<std::string>& columns,
                  const py::object& progress) {
  Loaded loaded;
  std::vector<Simulation> simulations;
  for (const py::handle& one : asked)
    simulations.push_back(simulation_of(py::reinterpret_borrow<py::dict>(one), loaded));

  std::vector<rollout::RollOut> outs(simulations.size());
  std::atomic<std::size_t> finished = 0;
  const auto report = [&] {
    if (!progress.is_none()) progress(finished.load());
  };
  run_interruptibly(
      [&](const std::atomic<bool>& stop) {
        gap::for_each_job(simulations.size(), jobs, [&](std::size_t i) {
          if (stop) return;
          const Simulation& of = simulations[i];
          outs[i] = rollout::roll_out(of.robot, *of.world, *of.manoeuvre, of.options);
          keep_columns(outs[i].run, columns);
          ++finished;
        });
      },
      report);
  report();

  py::list results;
  for (std::size_t i = 0; i < outs.size(); ++i) results.append(result_of(std::move(outs[i]), simulations[i]));
  return results;
}

std::vector<std::string> shipped(const char* folder, const char* extension) {
  std::vector<std::string> names;
  for (const auto& file : description::list_data_files(folder, extension)) names.push_back(file.stem());
  return names;
}

py::list manoeuvres() {
  py::list all;
  for (const Manoeuvre& manoeuvre : rollout::shipped_manoeuvres()) {
    py::dict one;
    one["name"] = manoeuvre.name;
    one["summary"] = manoeuvre.summary;
    one["world"] = manoeuvre.world;
    one["at_most_s"] = manoeuvre.at_most_s();
    all.append(one);
  }
  return all;
}

py::list parameters(const std::string& robot) {
  py::list all;
  const bool has_obstacles = true;  // as in a world that has them
  for (const gap::candidates::Candidate& c :
       gap::candidates::all_candidates(physics::load_robot(robot), has_obstacles)) {
    py::dict one;
    one["name"] = c.name;
    one["unit"] = c.unit;
    one["stage"] = physics::stage_name(c.stage);
    one["summary"] = c.summary;
    one["neutral"] = c.neutral;
    one["present"] = c.present;
    one["min"] = c.min;
    one["max"] = c.max;
    one["is_number_of_description"] = c.is_number_of_description;
    all.append(one);
  }
  return all;
}

std::map<std::string, double> noise_of(const std::string& robot, double noise_scale) {
  rollout::RollOutOptions options;
  options.noise_scale = noise_scale;
  return rollout::column_noise(physics::load_robot(robot), options);
}

}  // namespace

void add_simulate(py::module_& module) {
  module.def("simulate", &simulate);
  module.def("robots", [] { return shipped("robots", ".toml"); });
  module.def("worlds", [] { return shipped("worlds", ".sdf"); });
  module.def("manoeuvres", &manoeuvres);
  module.def("parameters", &parameters);
  module.def("noise_of", &noise_of);
}

}  // namespace kenaf::python
