#include "gap/diagnose/baseline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "formats/runs/run_file.hpp"
#include "gap/diagnose/repeats.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// A stage of two runs can be compared only if both are replays of the same kind.
bool seen_alike(const Observation& a, const Observation& b) {
  return a.measured.has_value() == b.measured.has_value();
}

// The runs of both datasets, the baseline's last, without names, as manoeuvre names may differ.
Observations joined(const Observations& now, Observations before) {
  Observations both;
  both.runs = now.runs;
  for (Observation& run : before.runs) {
    const std::string& name = before.worlds[run.world].name;
    const auto same = std::ranges::find(now.worlds, name, &physics::WorldDescription::name);
    if (same == now.worlds.end()) continue;
    run.world = static_cast<std::size_t>(same - now.worlds.begin());
    both.runs.push_back(std::move(run));
  }
  for (Observation& run : both.runs) run.manoeuvre.clear();
  return both;
}

// A stage's residual, averaged over the baseline's runs that repeat a run.
struct MeanResidual {
  double sum = 0, runs = 0;
};
using MeanResiduals = std::map<std::pair<std::size_t, std::size_t>, MeanResidual>;  // by channel and span

MeanResiduals mean_residuals(const std::vector<std::size_t>& runs, const std::vector<StageFeatures>& features,
                             const std::vector<VectorXd>& residuals) {
  MeanResiduals means;
  for (const std::size_t r : runs)
    for (std::size_t b = 0; b < features[r].bins.size(); ++b) {
      MeanResidual& mean = means[{features[r].bins[b].channel, features[r].bins[b].span}];
      mean.sum += residuals[r][static_cast<Index>(b)];
      ++mean.runs;
    }
  return means;
}

StageFeatures less(const StageFeatures& stage, const MeanResiduals& means) {
  StageFeatures result{{}, stage.span_s, {}, {}, {}};
  std::vector<double> measured, runs;
  for (std::size_t b = 0; b < stage.bins.size(); ++b) {
    const auto found = means.find({stage.bins[b].channel, stage.bins[b].span});
    if (found == means.end()) continue;
    result.bins.push_back(stage.bins[b]);
    result.rows.push_back(stage.rows[b]);
    measured.push_back(stage.measured[static_cast<Index>(b)] - found->second.sum / found->second.runs);
    runs.push_back(found->second.runs);
  }
  result.measured = Eigen::Map<const VectorXd>(measured.data(), std::ssize(measured));
  result.baseline_runs = Eigen::Map<const VectorXd>(runs.data(), std::ssize(runs));
  return result;
}

}  // namespace

Baseline observe_baseline(const std::filesystem::path& folder, Observations& now, const std::string& world,
                          const logs::RefusedRuns& refused_runs) {
  const Observations both =
      joined(now, observe(folder, now.robot_name, world, std::numeric_limits<std::size_t>::max(), refused_runs));
  const std::size_t count = now.runs.size();

  // for each new run, the baseline's runs of its group
  std::vector<std::vector<std::size_t>> of_run(count);
  for (const std::vector<std::size_t>& group : repeats_of(both))
    for (const std::size_t r : group)
      for (const std::size_t other : group)
        if (r < count && other >= count && seen_alike(both.runs[r], both.runs[other]))
          of_run[r].push_back(other - count);

  Baseline baseline;
  std::map<std::size_t, std::size_t> kept;  // index in `both`, less `count`, to index in the baseline
  std::vector<Observation> runs;
  for (std::size_t r = 0; r < count; ++r) {
    if (of_run[r].empty()) {
      now.warnings.push_back(fmt::format("{}: left out: no run of {} repeats it", now.runs[r].file, folder.string()));
      continue;
    }
    for (std::size_t& other : of_run[r]) {
      const auto [place, is_new] = kept.try_emplace(other, kept.size());
      if (is_new) baseline.observations.runs.push_back(both.runs[count + other]);
      other = place->second;
    }
    baseline.of_run.push_back(std::move(of_run[r]));
    runs.push_back(std::move(now.runs[r]));
  }
  now.runs = std::move(runs);
  if (now.runs.empty())
    throw runs::RunFileError(
        fmt::format("{}: none of its runs repeats a run of the diagnosis; record the same manoeuvres in the same "
                    "world, from the same initial speed, before and after",
                    folder.string()));
  baseline.observations.robot_name = now.robot_name;
  baseline.observations.robot = now.robot;
  baseline.observations.worlds = now.worlds;
  baseline.observations.not_simulated = now.not_simulated;
  return baseline;
}

void compare_against(ComparedFeatures& now, const Baseline& baseline, const ComparedFeatures& before,
                     const std::array<std::vector<VectorXd>, kPassages.size()>& residuals) {
  for (const Passage passage : kPassages) {
    const auto p = static_cast<std::size_t>(passage);
    for (std::size_t r = 0; r < now.of_stage[p].size(); ++r)
      now.of_stage[p][r] =
          less(now.of_stage[p][r], mean_residuals(baseline.of_run[r], before.of(passage), residuals[p]));
  }
}

}  // namespace kenaf::gap::diagnose
