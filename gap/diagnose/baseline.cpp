#include "gap/diagnose/baseline.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

#include "formats/runs/run_file.hpp"
#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/repeats.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
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
  StageFeatures result{{}, stage.span_s, {}, {}, stage.at_rest_s, {}, {}};
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

VectorXd counts_of(const std::vector<Bin>& bins) {
  VectorXd counts(std::ssize(bins));
  for (std::size_t b = 0; b < bins.size(); ++b)
    counts[static_cast<Index>(b)] = diagnosis_channels()[bins[b].channel].resolution;
  return counts;
}

// Each bin's change since the channel's bin before it; of its first bin, the value.
MatrixXd changes_of(const std::vector<Bin>& bins, const MatrixXd& values) {
  MatrixXd changes = values;
  for (std::size_t b = 1; b < bins.size(); ++b)
    if (bins[b].channel == bins[b - 1].channel)
      changes.row(static_cast<Index>(b)) -= values.row(static_cast<Index>(b) - 1);
  return changes;
}

// The channels that nothing on flat ground brings back.
constexpr std::array<std::string_view, 3> kCanStayOff{"x_m", "y_m", "yaw_rad"};

Eigen::Array<bool, Eigen::Dynamic, 1> can_stay_off(const std::vector<Bin>& bins) {
  Eigen::Array<bool, Eigen::Dynamic, 1> stay(std::ssize(bins));
  for (std::size_t b = 0; b < bins.size(); ++b)
    stay[static_cast<Index>(b)] = std::ranges::count(kCanStayOff, diagnosis_channels()[bins[b].channel].column) > 0;
  return stay;
}

// The differences of robot and simulation have sqrt(2) of one's; and as one example tells the size, sqrt(2) more of
// that (chosen: an example as small as half of the next one is not rare).
constexpr double kOfDifference = 2;

// A period is as long as a climb or a fall (chosen).
constexpr double kPeriod_s = 2;

std::size_t period_of(const StageFeatures& run, const Bin& bin) {
  return static_cast<std::size_t>(static_cast<double>(bin.span) * run.span_s / kPeriod_s);
}

std::size_t most_periods(const std::vector<StageFeatures>& features) {
  std::size_t most = 0;
  for (const StageFeatures& run : features)
    for (const Bin& bin : run.bins) most = std::max(most, period_of(run, bin) + 1);
  return most;
}

// For each of kCanStayOff and each period a column: the sum of the changes so far in this period, which later bins
// keep; 0 if it never reaches a count of the channel. `changes`: in counts.
MatrixXd ways_on(const StageFeatures& run, const VectorXd& changes, std::size_t periods) {
  MatrixXd ways = MatrixXd::Zero(changes.size(), static_cast<Index>(kCanStayOff.size() * periods));
  for (std::size_t b = 0; b < run.bins.size(); ++b) {
    const Bin& bin = run.bins[b];
    const auto channel = std::ranges::find(kCanStayOff, diagnosis_channels()[bin.channel].column);
    if (channel == kCanStayOff.end()) continue;
    const auto i = static_cast<Index>(b);
    const auto first = static_cast<Index>(periods) * (channel - kCanStayOff.begin());
    if (b > 0 && run.bins[b - 1].channel == bin.channel)
      ways.row(i).segment(first, static_cast<Index>(periods)) =
          ways.row(i - 1).segment(first, static_cast<Index>(periods));
    ways(i, first + static_cast<Index>(period_of(run, bin))) += changes[i];
  }
  for (auto way : ways.colwise())
    if (way.cwiseAbs().maxCoeff() < 1) way.setZero();
  return ways;
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

void add_other_ways(std::vector<OpenShapes>& open, const std::vector<StageFeatures>& features,
                    const std::vector<VectorXd>& simulated) {
  const std::size_t periods = most_periods(features);
  for (std::size_t r = 0; r < open.size(); ++r) {
    const std::vector<Bin>& bins = features[r].bins;
    if (features[r].baseline_simulated.size() == 0) continue;
    const VectorXd counts = counts_of(bins);
    const VectorXd difference = (simulated[r] - features[r].baseline_simulated).cwiseQuotient(counts);
    const MatrixXd start = counts.cwiseInverse().asDiagonal() * open[r].local.leftCols(kShapesOfStart);

    // the fit weighs changes, as after an obstacle all later values are off together
    const MatrixXd changes_of_start = changes_of(bins, start);
    const VectorXd rest =
        difference - start * changes_of_start.completeOrthogonalDecomposition().solve(changes_of(bins, difference));

    // of one run, whose noise counts for the baseline's as well
    const VectorXd one_run = kOfDifference * counts.cwiseQuotient(noise_of_difference(features[r]));
    const VectorXd happens = can_stay_off(bins).select(changes_of(bins, rest), rest);
    const VectorXd rough = largest_beside(bins, happens.cwiseAbs()).cwiseProduct(one_run);
    open[r].roughness = root_of_squares(open[r].roughness, rough);
    open[r].ways = one_run.asDiagonal() * ways_on(features[r], happens, periods);
  }
}

}  // namespace kenaf::gap::diagnose
