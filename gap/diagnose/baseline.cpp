#include "gap/diagnose/baseline.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "formats/runs/run_file.hpp"
#include "gap/diagnose/channels.hpp"
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

// Sums over the baseline's runs that repeat a run.
struct OfBaseline {
  double residual = 0, simulated = 0, runs = 0;
};
using BaselineBins = std::map<std::pair<std::size_t, std::size_t>, OfBaseline>;  // by channel and span

BaselineBins bins_of_baseline(const std::vector<std::size_t>& runs, const std::vector<StageFeatures>& features,
                              const std::vector<VectorXd>& residuals) {
  BaselineBins bins;
  for (const std::size_t r : runs)
    for (std::size_t b = 0; b < features[r].bins.size(); ++b) {
      OfBaseline& sum = bins[{features[r].bins[b].channel, features[r].bins[b].span}];
      const auto i = static_cast<Index>(b);
      sum.residual += residuals[r][i];
      sum.simulated += features[r].measured[i] - residuals[r][i];
      ++sum.runs;
    }
  return bins;
}

VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), std::ssize(values));
}

StageFeatures less_baseline(const StageFeatures& stage, const BaselineBins& baseline) {
  StageFeatures result{{}, stage.span_s, {}, {}, {}, {}};
  std::vector<double> measured, runs, simulated;
  for (std::size_t b = 0; b < stage.bins.size(); ++b) {
    const auto found = baseline.find({stage.bins[b].channel, stage.bins[b].span});
    if (found == baseline.end()) continue;
    const OfBaseline& sum = found->second;
    result.bins.push_back(stage.bins[b]);
    result.rows.push_back(stage.rows[b]);
    measured.push_back(stage.measured[static_cast<Index>(b)] - sum.residual / sum.runs);
    simulated.push_back(sum.simulated / sum.runs);
    runs.push_back(sum.runs);
  }
  result.measured = vector_of(measured);
  result.baseline_runs = vector_of(runs);
  result.baseline_simulated = vector_of(simulated);
  return result;
}

// For each bin the largest value of its channel up to one bin earlier or later.
VectorXd largest_beside(const std::vector<Bin>& bins, const VectorXd& values) {
  VectorXd largest = values;
  for (std::size_t b = 1; b < bins.size(); ++b) {
    if (bins[b].channel != bins[b - 1].channel || bins[b].span != bins[b - 1].span + 1) continue;
    const auto i = static_cast<Index>(b);
    largest[i] = std::max(largest[i], values[i - 1]);
    largest[i - 1] = std::max(largest[i - 1], values[i]);
  }
  return largest;
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
          less_baseline(now.of_stage[p][r], bins_of_baseline(baseline.of_run[r], before.of(passage), residuals[p]));
  }
}

void add_roughness_of_starts(std::vector<OpenShapes>& open, const std::vector<StageFeatures>& features,
                             const std::vector<VectorXd>& simulated) {
  for (std::size_t r = 0; r < open.size(); ++r) {
    if (features[r].baseline_simulated.size() == 0) continue;
    // in counts of the channels, less the best fit of the start pose's shapes
    VectorXd counts(std::ssize(features[r].bins));
    for (Index b = 0; b < counts.size(); ++b)
      counts[b] = diagnosis_channels()[features[r].bins[static_cast<std::size_t>(b)].channel].resolution;
    const Eigen::MatrixXd start = counts.cwiseInverse().asDiagonal() * open[r].local.leftCols(kShapesOfStart);
    const VectorXd difference = (simulated[r] - features[r].baseline_simulated).cwiseQuotient(counts);
    const VectorXd rest = difference - start * start.completeOrthogonalDecomposition().solve(difference);
    const VectorXd rough = largest_beside(features[r].bins, rest.cwiseAbs()).cwiseProduct(counts);
    open[r].roughness = root_of_squares(open[r].roughness, std::numbers::sqrt2 * rough);
  }
}

}  // namespace kenaf::gap::diagnose
