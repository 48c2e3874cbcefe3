#include "gap/diagnose/repeats.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace kenaf::gap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Of the mean size of the commands, how much repeats may differ on the average (chosen: a decision of an operator that
// comes half a second later changes 5 % of a climb, another step of speed all of it).
constexpr double kSameCommands = 0.2;

struct Differing {
  double difference = 0, size = 0;
};

// Both as they hold at the times of `a`; after the end of the shorter one nothing is compared.
void compare(const std::vector<rollout::TimedCommand>& a, const std::vector<rollout::TimedCommand>& b,
             Differing& tracks, Differing& flippers) {
  std::size_t at_b = 0;
  const double end_s = std::min(a.back().t_s, b.back().t_s);
  for (std::size_t i = 0; i + 1 < a.size() && a[i].t_s < end_s; ++i) {
    while (at_b + 1 < b.size() && b[at_b + 1].t_s <= a[i].t_s) ++at_b;
    const double duration_s = a[i + 1].t_s - a[i].t_s;
    const auto add = [&](Differing& sum, double one, double two) {
      sum.difference += duration_s * std::abs(one - two);
      sum.size += duration_s * (std::abs(one) + std::abs(two)) / 2;
    };
    for (std::size_t t = 0; t < a[i].command.track_speed_mps.size(); ++t)
      add(tracks, a[i].command.track_speed_mps[t], b[at_b].command.track_speed_mps[t]);
    for (std::size_t f = 0; f < a[i].command.flipper.size(); ++f)
      add(flippers, a[i].command.flipper[f].value, b[at_b].command.flipper[f].value);
  }
}

bool same_commands(const Observation& a, const Observation& b) {
  Differing tracks, flippers;
  compare(a.replay.timed, b.replay.timed, tracks, flippers);
  return tracks.difference <= kSameCommands * tracks.size && flippers.difference <= kSameCommands * flippers.size;
}

}  // namespace

std::vector<std::vector<std::size_t>> repeats_of(const Observations& observations) {
  std::vector<std::vector<std::size_t>> groups;
  std::map<std::pair<std::string, std::size_t>, std::vector<std::size_t>> groups_of_name;
  for (std::size_t r = 0; r < observations.runs.size(); ++r) {
    const Observation& run = observations.runs[r];
    std::vector<std::size_t>& candidates = groups_of_name[{run.manoeuvre, run.world}];
    const auto group = std::ranges::find_if(candidates, [&](std::size_t candidate) {
      return same_commands(observations.runs[groups[candidate].front()], run);
    });
    if (group != candidates.end()) {
      groups[*group].push_back(r);
    } else {
      candidates.push_back(groups.size());
      groups.push_back({r});
    }
  }
  return groups;
}

std::size_t representative(const Observations& observations, const std::vector<std::size_t>& group) {
  std::vector<std::size_t> sorted = group;
  std::ranges::stable_sort(sorted, {}, [&](std::size_t r) { return observations.runs[r].replay.at_most_s(); });
  return sorted[sorted.size() / 2];
}

std::vector<VectorXd> deviations_from_repeats(const std::vector<FeatureMap>& features,
                                              const std::vector<VectorXd>& residuals,
                                              const std::vector<std::vector<std::size_t>>& repeats) {
  struct Sum {
    double value = 0;
    int count = 0;
  };
  std::vector<VectorXd> result(residuals.size());
  for (const std::vector<std::size_t>& group : repeats) {
    if (group.size() < 2) continue;
    std::map<std::pair<std::size_t, std::size_t>, Sum> sums;
    const auto each_bin = [&](auto&& use) {
      for (const std::size_t r : group)
        for (std::size_t b = 0; b < features[r].bins().size(); ++b)
          use(r, static_cast<Index>(b), sums[{features[r].bins()[b].channel, features[r].bins()[b].span}]);
    };
    for (const std::size_t r : group) result[r] = VectorXd::Zero(residuals[r].size());
    each_bin([&](std::size_t r, Index b, Sum& sum) { sum.value += residuals[r][b], ++sum.count; });
    each_bin([&](std::size_t r, Index b, Sum& sum) {
      if (sum.count > 1)
        result[r][b] = (residuals[r][b] - sum.value / sum.count) * std::sqrt(sum.count / (sum.count - 1.0));
    });
  }
  return result;
}

std::vector<std::vector<bool>> shared_bins(const std::vector<FeatureMap>& features,
                                           const std::vector<std::vector<std::size_t>>& repeats) {
  std::vector<std::vector<bool>> shared(features.size());
  for (const std::vector<std::size_t>& group : repeats) {
    std::map<std::pair<std::size_t, std::size_t>, int> count;
    for (const std::size_t r : group)
      for (const Bin& bin : features[r].bins()) ++count[{bin.channel, bin.span}];
    for (const std::size_t r : group)
      for (const Bin& bin : features[r].bins()) shared[r].push_back(count[{bin.channel, bin.span}] > 1);
  }
  return shared;
}

}  // namespace kenaf::gap
