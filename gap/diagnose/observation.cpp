#include "gap/diagnose/observation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "gap/diagnose/channels.hpp"
#include "gap/logs/body_heading.hpp"
#include "gap/logs/copies.hpp"
#include "gap/logs/held_samples.hpp"
#include "gap/logs/lifted_robot.hpp"
#include "gap/logs/other_forms.hpp"
#include "gap/logs/plausibility.hpp"
#include "gap/logs/unknown_columns.hpp"
#include "robot/angles.hpp"
#include "rollout/measured_motion.hpp"
#include "rollout/roll_out.hpp"

namespace kenaf::gap::diagnose {
namespace {

namespace fs = std::filesystem;

constexpr double kMoves_mps = 1e-6, kShortest_s = 0.5;

// Rows before the first command to move.
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

double as_it_is(double difference) {
  return difference;
}

// The mean of the first `rows`, relative to `first`; `wrap` wraps differences of angles.
double mean_of_first(std::span<const double> column, std::size_t rows, double first, double (*wrap)(double)) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < std::min(rows, column.size()); ++i)
    if (!std::isnan(column[i])) sum += wrap(column[i] - first), ++count;
  return count > 0 ? first + sum / count : first;
}

// The first pose of a log has the full noise of its sensor; the mean of the rows before the first command has less,
// unless the robot was rolling at the start.
void start_at_mean(const Observation& observation, rollout::Manoeuvre& replay) {
  rollout::Start& start = *replay.start;
  if (start.motion) return;
  const std::size_t rows = observation.resting_rows;
  start.x_m = mean_of_first(observation.run.column("x_m"), rows, start.x_m, as_it_is);
  start.y_m = mean_of_first(observation.run.column("y_m"), rows, start.y_m, as_it_is);
  start.yaw_rad = mean_of_first(observation.run.column("yaw_rad"), rows, start.yaw_rad, robot::wrap_angle);
}

void count_time_from_zero(runs::Run& run) {
  const auto column = std::ranges::find(run.columns, "t_s") - run.columns.begin();
  std::vector<double>& time = run.values[static_cast<std::size_t>(column)];
  const double first_s = time.front();
  for (double& t_s : time) t_s -= first_s;
}

void prepare_replays(Observation& observation, const std::string& path) {
  observation.resting_rows = resting_rows(observation.replay);
  start_at_mean(observation, observation.replay);
  if (rollout::measured_motion(observation.run).track_mps[0].empty()) return;
  observation.measured = rollout::replay_measured_of(observation.run, path);
  start_at_mean(observation, *observation.measured);
}

void empty_column(runs::Run& run, const std::string& name) {
  for (std::size_t c = 0; c < run.columns.size(); ++c)
    if (run.columns[c] == name) std::ranges::fill(run.values[c], std::nan(""));
}

void empty_repeats(runs::Run& run, const std::string& name) {
  const std::optional<logs::HeldSamples> held = logs::held_samples(run.column("t_s"), run.column(name));
  if (!held) return;
  const auto column = static_cast<std::size_t>(std::ranges::find(run.columns, name) - run.columns.begin());
  for (const std::size_t row : held->repeats) run.values[column][row] = std::nan("");
}

// Without a heading to start with, a simulated robot goes another way in the plane. Returns whether a place was
// forgotten.
bool forget_place_without_heading(runs::Run& run) {
  const bool has_place = runs::any_measured(run.column("x_m")) || runs::any_measured(run.column("y_m"));
  if (!has_place || runs::any_measured(run.column("yaw_rad"))) return false;
  for (const char* name : {"x_m", "y_m"}) empty_column(run, name);
  return true;
}

// Clears the columns of dead sensors, and cells that only repeat a value. Returns what is certainly wrong, or nothing
// if that is taken nevertheless.
std::optional<std::string> check(runs::Run& run, const std::string& file, bool unchecked, logs::HeldInRuns& held,
                                 Observations& result) {
  std::vector<logs::Finding> found = logs::check_run(run, file, &result.robot);
  for (const logs::Finding& finding : found)
    if (finding.severity == logs::Finding::Severity::held) empty_repeats(run, finding.column);
  held.take_off(found);
  for (const logs::Finding& finding : found) {
    const std::string words = in_words(finding);
    if (finding.severity == logs::Finding::Severity::refuse && !unchecked) return words;
    const bool is_dead = finding.severity == logs::Finding::Severity::dead;
    if (is_dead) empty_column(run, finding.column);
    result.warnings.push_back(is_dead ? words + " (left out)" : words);
  }
  return std::nullopt;
}

// At most `most` runs, evenly from all manoeuvres, spread over the dataset.
std::vector<runs::DatasetRun> drawn_evenly(const std::vector<runs::DatasetRun>& all, std::size_t most) {
  if (all.size() <= most) return all;
  std::map<std::pair<std::string, std::string>, std::vector<std::size_t>> of_manoeuvre;
  for (std::size_t i = 0; i < all.size(); ++i) of_manoeuvre[{all[i].manoeuvre, all[i].world}].push_back(i);
  std::vector<std::vector<std::size_t>> groups;
  for (auto& [name, runs] : of_manoeuvre) groups.push_back(std::move(runs));
  // more manoeuvres than runs: one run of each of `most` manoeuvres, spread over their names
  if (groups.size() > most) {
    std::vector<std::vector<std::size_t>> kept;
    for (std::size_t i = 0; i < most; ++i) kept.push_back(std::move(groups[i * groups.size() / most]));
    groups = std::move(kept);
  }
  std::ranges::stable_sort(groups, {}, &std::vector<std::size_t>::size);
  std::vector<std::size_t> drawn;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::size_t share = std::min(groups[g].size(), (most - drawn.size()) / (groups.size() - g));
    for (std::size_t i = 0; i < share; ++i) drawn.push_back(groups[g][i * groups[g].size() / share]);
  }
  std::ranges::sort(drawn);
  std::vector<runs::DatasetRun> result;
  for (const std::size_t i : drawn) result.push_back(all[i]);
  return result;
}

std::vector<std::string> channels_not_simulated(const Observations& observations) {
  const std::vector<std::string> simulated = rollout::recorded_columns(observations.robot);
  std::vector<std::string> result;
  for (const Channel& channel : diagnosis_channels()) {
    const std::string column(channel.column);
    const auto measures = [&](const Observation& observation) {
      return runs::any_measured(observation.run.column(column));
    };
    if (std::ranges::count(simulated, column) == 0 && std::ranges::any_of(observations.runs, measures))
      result.push_back(column);
  }
  return result;
}

}  // namespace

bool has_obstacles(const Observations& observations) {
  return std::ranges::any_of(observations.worlds, [](const physics::WorldDescription& world) {
    return !world.boxes.empty() || !world.meshes.empty();
  });
}

Observation observation_of(const runs::DatasetRun& entry, runs::Run run, const std::string& path) {
  Observation observation{entry.file, entry.manoeuvre, 0, std::move(run), {}, {}, 0};
  count_time_from_zero(observation.run);
  observation.replay = rollout::replay_of(observation.run, path);
  prepare_replays(observation, path);
  return observation;
}

Observations observe(const fs::path& folder, const std::string& robot, const std::string& world, std::size_t most_runs,
                     const logs::RefusedRuns& refused_runs) {
  Observations result;
  // the dataset, its robot, and the runs that are used of it
  result.dataset = runs::read_dataset(folder);
  result.robot_name = robot.empty() ? runs::resolve_beside(folder, result.dataset.robot, ".toml") : robot;
  result.robot = physics::load_robot(result.robot_name);
  const std::vector<runs::DatasetRun> entries = drawn_evenly(result.dataset.runs, most_runs);
  if (entries.size() < result.dataset.runs.size())
    result.warnings.push_back(fmt::format("{} of {} runs are used, sampled evenly from all manoeuvres", entries.size(),
                                          result.dataset.runs.size()));

  // each usable run with its replays; faulty, copied and too short ones are left out, worlds are loaded once
  std::map<std::string, std::size_t> worlds;
  logs::KnownRuns known_runs;
  std::vector<logs::Finding> copies;
  std::vector<std::string> refused, without_heading;
  logs::HeldInRuns held;
  logs::LiftedRobot lifted;
  logs::BodyHeading heading;
  logs::OtherForms forms;
  logs::UnknownColumns unknown;
  for (const runs::DatasetRun& entry : entries) {
    // unusable: failed simulations and copies
    if (!entry.fault.empty()) {
      result.warnings.push_back(fmt::format("{}: left out, because its simulation failed", entry.file));
      continue;
    }
    Observation observation{entry.file, entry.manoeuvre, 0, {}, {}, {}, 0};
    std::vector<logs::Finding> unreadable;
    std::optional<runs::Run> read = logs::read_or_refuse(folder / entry.file, entry.file, unreadable);
    if (!read) {
      refused.push_back(in_words(unreadable.front()));
      continue;
    }
    observation.run = std::move(*read);
    forms.look_at(observation.run, entry.file);
    unknown.look_at(observation.run, entry.file);
    if (const auto copy = known_runs.copy(observation.run, entry.file)) {
      copies.push_back(*copy);
      continue;
    }

    // its commands, without implausible values
    if (const auto wrong = check(observation.run, entry.file, refused_runs.unchecked, held, result)) {
      refused.push_back(*wrong);
      continue;
    }
    heading.look_at(observation.run);
    count_time_from_zero(observation.run);
    const std::string path = (folder / entry.file).string();
    try {
      observation.replay = rollout::replay_of(observation.run, path);
    } catch (const runs::RunFileError& error) {  // of a run that was not checked
      refused.push_back(error.what());
      continue;
    }
    if (observation.replay.at_most_s() < kShortest_s) {
      result.warnings.push_back(fmt::format("{}: left out, because it is shorter than {} s", entry.file, kShortest_s));
      continue;
    }

    // its world, by the name that resolves it
    const std::string name =
        !world.empty() ? world
                       : runs::resolve_beside(folder, entry.world.empty() ? result.dataset.world : entry.world, ".sdf");
    const auto [known, is_new] = worlds.try_emplace(name, result.worlds.size());
    if (is_new) result.worlds.push_back(physics::load_world(name, result.warnings));

    // its replays
    observation.world = known->second;
    prepare_replays(observation, path);
    lifted.look_at(observation.run, result.robot.track_gauge_m());
    if (forget_place_without_heading(observation.run)) without_heading.push_back(entry.file);
    result.runs.push_back(std::move(observation));
  }

  // runs that are certainly wrong are left out if they are few
  if (refused_runs.too_many(refused.size(), entries.size()))
    throw runs::RunFileError(fmt::format("{}/{}", folder.string(), refused.front()));
  for (const std::string& words : refused) result.warnings.push_back(words + " (the run is left out)");

  // a pose in another frame than the heading is wrong in all runs
  for (const logs::Finding& finding : heading.findings()) {
    if (finding.severity == logs::Finding::Severity::refuse && !refused_runs.unchecked)
      throw runs::RunFileError(fmt::format("{}/{}", folder.string(), in_words(finding)));
    result.warnings.push_back(in_words(finding));
  }

  // a robot lifted off the ground shows nothing of the body's motion: only its drives are compared
  if (const auto finding = lifted.finding()) {
    for (Observation& observation : result.runs) logs::forget_body(observation.run);
    result.warnings.push_back(in_words(*finding) + " (the drives alone are compared)");
  }

  // findings that concern several runs, once each
  if (!without_heading.empty())
    result.warnings.push_back(fmt::format(
        "{}: yaw_rad: is missing or empty: where the robot headed at the start is unknown, so x_m and y_m are not "
        "compared; kenaf-gap merge adds the pose from motion capture to a run{}",
        without_heading.front(),
        without_heading.size() > 1 ? fmt::format(" (as in {} more)", without_heading.size() - 1) : ""));
  for (const logs::Finding& finding : forms.findings()) result.warnings.push_back(in_words(finding));
  for (const logs::Finding& finding : unknown.findings()) result.warnings.push_back(in_words(finding));
  for (const logs::Finding& finding : held.findings())
    result.warnings.push_back(in_words(finding) + " (repeats left out)");
  if (!copies.empty())
    result.warnings.push_back(
        in_words(copies.front()) +
        (copies.size() == 1 ? " (left out)" : fmt::format(" (left out, as {} more)", copies.size() - 1)));

  // without a usable run the first warning says why
  if (result.runs.empty())
    throw runs::RunFileError(fmt::format("{}: none of its {} runs can be used{}", folder.string(),
                                         result.dataset.runs.size(),
                                         result.warnings.empty() ? "" : "; the first one: " + result.warnings.front()));

  // warn of stated noise that cannot be right, and of channels that the described robot has no sensor for
  std::vector<std::vector<std::string>> columns;
  for (const Observation& run : result.runs) columns.push_back(run.run.columns);
  for (const logs::Finding& finding : logs::check_noise(result.dataset, columns))
    result.warnings.push_back(in_words(finding));
  result.not_simulated = channels_not_simulated(result);
  for (const std::string& column : result.not_simulated)
    result.warnings.push_back(
        fmt::format("{}: not compared, because the described robot has no sensor for it", column));
  return result;
}

}  // namespace kenaf::gap::diagnose
