#include "gap/compare/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "gap/compare/pair_runs.hpp"
#include "gap/logs/plausibility.hpp"

namespace kenaf::gap::compare {

namespace {

namespace fs = std::filesystem;

double sim_period_s(const ComparedRun& run) {
  return (run.sim.back().t_s - run.sim.front().t_s) / static_cast<double>(run.sim.size() - 1);
}

std::optional<std::size_t> band_frames(const ComparedRun& run, const CompareOptions& options) {
  if (!options.band_s) return std::nullopt;
  const auto all = static_cast<double>(run.sim.size());
  return static_cast<std::size_t>(std::min(all, std::ceil(*options.band_s / sim_period_s(run))));
}

void match(ComparedRun& run, const CompareOptions& options) {
  const std::optional<std::size_t> band = band_frames(run, options);
  if (weighed_pairs(run.real.size(), run.sim.size(), band) > kMostWeighedPairs) {
    const double frames = static_cast<double>(kMostWeighedPairs) / static_cast<double>(run.real.size()) / 2 - 1;
    throw std::runtime_error(fmt::format(
        "{} against {}: {} x {} frames are too many for unlimited matching; give --band SECONDS of at most {:.3g}",
        run.real_file, run.sim_file, run.real.size(), run.sim.size(), frames * sim_period_s(run)));
  }
  run.matching = match_paths(path_in(run.plane, run.real), path_in(run.plane, run.sim), band);
  run.errors = run_errors(run.plane, run.real, run.sim, run.matching.pairs);
}

PoseFrames frames_of(const runs::DatasetRun& run, const fs::path& folder) {
  const runs::Run columns = runs::read_run(folder / run.file);
  PoseFrames frames = pose_frames(columns);
  if (!frames.unusable.empty()) return frames;
  constexpr std::string_view kOfPose[] = {"x_m", "y_m", "z_m", "roll_rad", "pitch_rad", "yaw_rad"};
  for (const logs::Finding& finding : logs::check_units(columns, run.file))
    if (finding.severity == logs::Finding::Severity::refuse && std::ranges::count(kOfPose, finding.column) > 0)
      frames.unusable = finding.column + " " + finding.text;
  if (!run.fault.empty()) frames.unusable = "its simulation failed: " + run.fault;
  return frames;
}

std::string world_of(const runs::DatasetRun& run, const runs::Dataset& dataset, const fs::path& folder) {
  return runs::resolve_beside(folder, run.world.empty() ? dataset.world : run.world, ".sdf");
}

std::string nothing_left(const Comparison& comparison) {
  std::string text = "no pair of runs can be compared:";
  for (const LeftOut& run : comparison.left_out) {
    text += fmt::format("\n  {} {}{}: {}", run.dataset, run.file,
                        run.manoeuvre.empty() ? "" : " (" + run.manoeuvre + ")", run.why);
  }
  return text;
}

}  // namespace

Comparison compare_datasets(const fs::path& real_folder, const fs::path& sim_folder, const CompareOptions& options) {
  Comparison comparison{
      real_folder, sim_folder, runs::read_dataset(real_folder), runs::read_dataset(sim_folder), options, {}, {}};
  const auto leave_out = [&comparison](bool is_real, std::size_t index, std::string why) {
    const runs::DatasetRun& run = (is_real ? comparison.real : comparison.sim).runs[index];
    comparison.left_out.push_back({is_real ? "real" : "sim", run.file, run.manoeuvre, std::move(why)});
  };

  // Runs are paired by manoeuvre and repeat. Where one of a pair cannot be compared, both are left out with a reason.
  const RunPairs pairs = pair_runs(comparison.real, comparison.sim);
  for (const RunPair& pair : pairs.pairs) {
    const runs::DatasetRun &real = comparison.real.runs[pair.real], &sim = comparison.sim.runs[pair.sim];
    PoseFrames real_frames = frames_of(real, real_folder), sim_frames = frames_of(sim, sim_folder);
    if (!real_frames.unusable.empty() || !sim_frames.unusable.empty()) {
      const auto why = [](const PoseFrames& own, const std::string& counterpart) {
        return own.unusable.empty() ? "its counterpart " + counterpart + " cannot be compared" : own.unusable;
      };
      leave_out(true, pair.real, why(real_frames, sim.file));
      leave_out(false, pair.sim, why(sim_frames, real.file));
      continue;
    }

    // Both in one plane: one that has a height is compared without it to one that has none.
    const Plane plane = plane_of(real_frames.frames, sim_frames.frames);
    real_frames.frames = frames_in(plane, std::move(real_frames.frames));
    sim_frames.frames = frames_in(plane, std::move(sim_frames.frames));
    if (std::min(real_frames.frames.size(), sim_frames.frames.size()) < 2) {
      const bool of_real = real_frames.frames.size() < 2;
      leave_out(of_real, of_real ? pair.real : pair.sim, "has no y_m, and its counterpart no z_m");
      leave_out(!of_real, of_real ? pair.sim : pair.real, "has no z_m, and its counterpart no y_m");
      continue;
    }

    // The simulated run is moved to the real one's start, then matched frame by frame.
    ComparedRun run{real.manoeuvre,
                    pair.repeat,
                    real.file,
                    sim.file,
                    world_of(real, comparison.real, real_folder),
                    world_of(sim, comparison.sim, sim_folder),
                    plane,
                    std::move(real_frames.frames),
                    std::move(sim_frames.frames),
                    {},
                    {},
                    {}};
    if (options.align_start) run.start_offset = align_start(run.real, run.sim, options.start_s);
    match(run, options);
    comparison.runs.push_back(std::move(run));
  }

  for (const LeftOutRun& run : pairs.left_out) leave_out(run.side == LeftOutRun::Side::real, run.index, run.why);
  if (comparison.runs.empty()) throw std::runtime_error(nothing_left(comparison));
  return comparison;
}

std::vector<ManoeuvreErrors> by_manoeuvre(const Comparison& comparison) {
  std::vector<ManoeuvreErrors> manoeuvres;
  for (std::size_t i = 0; i < comparison.runs.size(); ++i) {
    const ComparedRun& run = comparison.runs[i];
    auto found = std::ranges::find(manoeuvres, run.manoeuvre, &ManoeuvreErrors::manoeuvre);
    if (found == manoeuvres.end()) found = manoeuvres.insert(found, {run.manoeuvre, {}, {}, {}});
    found->runs.push_back(i);
    found->matched.add(run.errors.matched_summary);
    found->same_time.add(run.errors.same_time_summary);
  }
  return manoeuvres;
}

ManoeuvreErrors over_all(const Comparison& comparison) {
  ManoeuvreErrors all;
  for (const ManoeuvreErrors& manoeuvre : by_manoeuvre(comparison)) {
    all.runs.insert(all.runs.end(), manoeuvre.runs.begin(), manoeuvre.runs.end());
    all.matched.add(manoeuvre.matched);
    all.same_time.add(manoeuvre.same_time);
  }
  return all;
}

}  // namespace kenaf::gap::compare
