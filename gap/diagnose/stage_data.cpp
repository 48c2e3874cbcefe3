#include "gap/diagnose/stage_data.hpp"

#include <cmath>
#include <map>
#include <utility>

#include "gap/diagnose/channels.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Share of the numerics' standard deviation that is separate in each group (chosen): shapes are linear in them to about
// that.
constexpr double kNumericsOfRun = 0.3;

// The bins of all runs of a group, and the index in them of each run's bins.
StageGroup bins_of_group(const std::vector<StageFeatures>& features, std::vector<std::size_t> runs,
                         const UsedParts& used) {
  // the union of all runs' bins; the map sorts them by channel, then by time
  StageGroup group{std::move(runs), {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
  std::map<std::pair<std::size_t, std::size_t>, Index> place;
  for (const std::size_t r : group.runs)
    for (const Bin& bin : features[r].bins) place[{bin.channel, bin.span}] = 0;

  // number them in that order, with each channel's range and each bin's middle time
  for (auto& [key, index] : place) {
    const auto [channel, span] = key;
    index = std::ssize(group.bins);
    if (group.series.empty() || group.series.back().channel != channel)
      group.series.push_back({index, 0, channel, kind_of(channel)});
    ++group.series.back().count;
    group.bins.push_back({channel, span, 0});
    group.t_s.push_back((static_cast<double>(span) + 0.5) * features[group.runs.front()].span_s);
  }

  // the group's index of each run's bin, and how many used runs have each bin
  group.count = VectorXd::Zero(std::ssize(group.bins));
  for (const std::size_t r : group.runs) {
    group.bin_of.emplace_back();
    for (const Bin& bin : features[r].bins) {
      const Index index = place[{bin.channel, bin.span}];
      group.bin_of.back().push_back(index);
      group.bins[static_cast<std::size_t>(index)].samples += bin.samples;
      if (used.holds(r, group.t_s[static_cast<std::size_t>(index)])) ++group.count[index];
    }
  }
  return group;
}

// Each run's matrix, averaged for each bin over the used runs that have it; 0 if none has.
template <class MatrixOfRun>
MatrixXd mean_over_runs(const StageGroup& group, Index columns, const UsedParts& used, MatrixOfRun&& matrix_of) {
  MatrixXd sum = MatrixXd::Zero(std::ssize(group.bins), columns);
  VectorXd count = VectorXd::Zero(sum.rows());
  for (std::size_t i = 0; i < group.runs.size(); ++i) {
    const auto& values = matrix_of(group.runs[i]);
    for (std::size_t b = 0; b < group.bin_of[i].size(); ++b) {
      const Index index = group.bin_of[i][b];
      if (!used.holds(group.runs[i], group.t_s[static_cast<std::size_t>(index)])) continue;
      sum.row(index) += values.row(static_cast<Index>(b));
      ++count[index];
    }
  }
  return count.cwiseMax(1).cwiseInverse().asDiagonal() * sum;
}

}  // namespace

StageData stage_data(Passage passage, const std::vector<StageFeatures>& features,
                     const std::vector<std::vector<std::size_t>>& repeats, const std::vector<VectorXd>& residuals,
                     const NoiseFloor& floor, const UsedParts& used) {
  StageData data{passage, {}};
  for (const std::vector<std::size_t>& repeated : repeats) {
    std::vector<std::size_t> runs;
    for (const std::size_t r : repeated)
      if (!features[r].bins.empty()) runs.push_back(r);
    if (runs.empty()) continue;
    StageGroup group = bins_of_group(features, std::move(runs), used);
    VectorXd one_run = group.count.cwiseMax(1).cwiseInverse();
    group.residual = mean_over_runs(group, 1, used, [&](std::size_t r) -> const VectorXd& { return residuals[r]; });

    // variances of two independent means add
    const bool has_baseline = features[group.runs.front()].baseline_runs.size() > 0;
    if (has_baseline)
      one_run += VectorXd(mean_over_runs(group, 1, {}, [&](std::size_t r) {
                   return features[r].baseline_runs;
                 })).cwiseInverse();

    // noise is independent between runs: the variance of a mean of n is 1 / n of that of one
    const MatrixXd variance =
        mean_over_runs(group, 1, used, [&](std::size_t r) { return VectorXd(floor.sigma_of_bin[r].array().square()); });
    group.variance = (group.count.array() > 0).select(variance.cwiseProduct(one_run), kVarianceIfUnused);

    // so are start poses and counts; the simulator's numbers are the same in all runs, except for nonlinear effects:
    // only these remain against a baseline
    const std::size_t any = group.runs.front();
    const Index local_shapes = floor.open[any].local.cols() + floor.open[any].ways.cols();
    const MatrixXd local =
        mean_over_runs(group, local_shapes, used, [&](std::size_t r) { return shapes_of_run(floor.open[r]); });
    group.shared_shapes = mean_over_runs(group, floor.open[any].numerics.cols(), used,
                                         [&](std::size_t r) -> const MatrixXd& { return floor.open[r].numerics; });
    group.local_shapes.resize(local.rows(), local.cols() + group.shared_shapes.cols());
    group.local_shapes << one_run.cwiseSqrt().asDiagonal() * local, kNumericsOfRun * group.shared_shapes;
    if (has_baseline) group.shared_shapes.setZero();
    group.number_shapes =
        floor.number_shapes.empty() ? MatrixXd(local.rows(), 0) : floor.number_shapes[data.groups.size()];
    data.groups.push_back(std::move(group));
  }
  return data;
}

std::vector<VectorXd> mean_of_groups(const StageData& data, const std::vector<VectorXd>& of_runs) {
  std::vector<VectorXd> means;
  for (const StageGroup& group : data.groups)
    means.push_back(mean_over_runs(group, 1, {}, [&](std::size_t r) -> const VectorXd& { return of_runs[r]; }));
  return means;
}

std::size_t bin_count(const StageData& data) {
  std::size_t count = 0;
  for (const StageGroup& group : data.groups) count += group.bins.size();
  return count;
}

}  // namespace kenaf::gap::diagnose
