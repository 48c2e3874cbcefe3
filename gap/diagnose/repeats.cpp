#include "gap/diagnose/repeats.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Tolerances between repeats (chosen): time of an operator's command, relative rounding of a log's numbers, and share
// of the time with other commands.
constexpr double kSooner_s = 0.5, kRounded = 0.02, kOtherwise = 0.1;
// Share of the largest commanded speed (chosen: more than the noise of a speed at rest, less than another motion).
constexpr double kMovesOtherwise = 0.25;

using Timed = std::vector<rollout::TimedCommand>;

struct Largest {
  double track_mps = 0, flipper_rad = 0;
};

void widen(Largest& largest, const Timed& commands) {
  for (const rollout::TimedCommand& timed : commands) {
    for (const double speed_mps : timed.command.track_speed_mps)
      largest.track_mps = std::max(largest.track_mps, std::abs(speed_mps));
    for (const auto& flipper : timed.command.flipper)
      largest.flipper_rad = std::max(largest.flipper_rad, std::abs(flipper.value));
  }
}

bool alike(const robot::Command& a, const robot::Command& b, const Largest& largest) {
  for (std::size_t t = 0; t < a.track_speed_mps.size(); ++t)
    if (std::abs(a.track_speed_mps[t] - b.track_speed_mps[t]) > kRounded * largest.track_mps) return false;
  for (std::size_t f = 0; f < a.flipper.size(); ++f)
    if (std::abs(a.flipper[f].value - b.flipper[f].value) > kRounded * largest.flipper_rad) return false;
  return true;
}

// Total time for which `b` has no similar command near the time of that of `a`, up to the end of the shorter one.
double otherwise_s(const Timed& a, const Timed& b, const Largest& largest) {
  const double end_s = std::min(a.back().t_s, b.back().t_s);
  double sum_s = 0;
  for (std::size_t i = 0; i + 1 < a.size() && a[i].t_s < end_s; ++i) {
    // including the command in force at the start of that window
    auto near = std::ranges::upper_bound(b, a[i].t_s - kSooner_s, {}, &rollout::TimedCommand::t_s);
    if (near != b.begin()) --near;
    bool found = false;
    for (; !found && near != b.end() && near->t_s <= a[i].t_s + kSooner_s; ++near)
      found = alike(a[i].command, near->command, largest);
    if (!found) sum_s += a[i + 1].t_s - a[i].t_s;
  }
  return sum_s;
}

Largest largest_of(const Observation& a, const Observation& b) {
  Largest largest;
  widen(largest, a.replay.timed);
  widen(largest, b.replay.timed);
  return largest;
}

// Both tracks' speeds, or the body's speed for both if they were not measured.
std::array<double, robot::kTrackCount> speeds_at_start(const Observation& observation) {
  const auto& start = observation.replay.start;
  if (!start || !start->motion) return {};
  if (start->motion->track_mps) return *start->motion->track_mps;
  const double forward_mps = start->motion->forward_mps.value_or(0);
  return {forward_mps, forward_mps};
}

bool same_start(const Observation& a, const Observation& b) {
  const auto one = speeds_at_start(a), two = speeds_at_start(b);
  const double allowed_mps = kMovesOtherwise * largest_of(a, b).track_mps;
  for (std::size_t t = 0; t < one.size(); ++t)
    if (std::abs(one[t] - two[t]) > allowed_mps) return false;
  return true;
}

bool same_commands(const Observation& a, const Observation& b) {
  const Timed &one = a.replay.timed, &two = b.replay.timed;
  const Largest largest = largest_of(a, b);
  const double allowed_s = kOtherwise * std::min(one.back().t_s, two.back().t_s);
  return otherwise_s(one, two, largest) <= allowed_s && otherwise_s(two, one, largest) <= allowed_s;
}

// The sequence of distinct commands, regardless of duration.
std::vector<robot::Command> distinct_commands_of(const Timed& commands, const Largest& largest) {
  std::vector<robot::Command> distinct;
  for (const rollout::TimedCommand& timed : commands)
    if (distinct.empty() || !alike(distinct.back(), timed.command, largest)) distinct.push_back(timed.command);
  return distinct;
}

bool same_command_sequence(const Observation& a, const Observation& b) {
  const Largest largest = largest_of(a, b);
  std::vector<robot::Command> fewer = distinct_commands_of(a.replay.timed, largest),
                              more = distinct_commands_of(b.replay.timed, largest);
  if (fewer.size() > more.size()) std::swap(fewer, more);
  std::size_t found = 0;
  for (std::size_t i = 0; i < more.size() && found < fewer.size(); ++i) found += alike(fewer[found], more[i], largest);
  return found == fewer.size() && more.size() <= 2 * fewer.size();
}

template <class Same>
std::vector<std::vector<std::size_t>> groups_of(const Observations& observations, Same&& same) {
  std::vector<std::vector<std::size_t>> groups;
  std::map<std::pair<std::string, std::size_t>, std::vector<std::size_t>> groups_of_name;
  for (std::size_t r = 0; r < observations.runs.size(); ++r) {
    const Observation& run = observations.runs[r];
    std::vector<std::size_t>& candidates = groups_of_name[{run.manoeuvre, run.world}];
    const auto group = std::ranges::find_if(
        candidates, [&](std::size_t candidate) { return same(observations.runs[groups[candidate].front()], run); });
    if (group != candidates.end()) {
      groups[*group].push_back(r);
    } else {
      candidates.push_back(groups.size());
      groups.push_back({r});
    }
  }
  return groups;
}

}  // namespace

std::vector<std::vector<std::size_t>> repeats_of(const Observations& observations) {
  return groups_of(observations,
                   [](const Observation& a, const Observation& b) { return same_start(a, b) && same_commands(a, b); });
}

std::vector<std::vector<std::size_t>> same_command_sequence_of(const Observations& observations) {
  return groups_of(observations, [](const Observation& a, const Observation& b) {
    return same_start(a, b) && (same_commands(a, b) || same_command_sequence(a, b));
  });
}

std::size_t representative(const Observations& observations, const std::vector<std::size_t>& group) {
  std::vector<std::size_t> sorted = group;
  std::ranges::stable_sort(sorted, {}, [&](std::size_t r) { return observations.runs[r].replay.at_most_s(); });
  return sorted[sorted.size() / 2];
}

Deviations deviations_from_repeats(const std::vector<StageFeatures>& features, const std::vector<VectorXd>& residuals,
                                   const std::vector<std::vector<std::size_t>>& repeats) {
  struct Sum {
    double value = 0;
    int count = 0;
  };
  Deviations result{std::vector<VectorXd>(residuals.size()), shared_bins(features, repeats)};
  for (const std::vector<std::size_t>& group : repeats) {
    if (group.size() < 2) continue;
    // sums over the group's runs by channel and span
    std::map<std::pair<std::size_t, std::size_t>, Sum> sums;
    const auto each_bin = [&](auto&& use) {
      for (const std::size_t r : group)
        for (std::size_t b = 0; b < features[r].bins.size(); ++b)
          use(r, static_cast<Index>(b), sums[{features[r].bins[b].channel, features[r].bins[b].span}]);
    };

    // x - mean of n has the variance (n - 1) / n of one run: scaled by sqrt(n / (n - 1))
    for (const std::size_t r : group) result.of_runs[r] = VectorXd::Zero(residuals[r].size());
    each_bin([&](std::size_t r, Index b, Sum& sum) { sum.value += residuals[r][b], ++sum.count; });
    each_bin([&](std::size_t r, Index b, Sum& sum) {
      if (sum.count > 1)
        result.of_runs[r][b] = (residuals[r][b] - sum.value / sum.count) * std::sqrt(sum.count / (sum.count - 1.0));
    });
  }
  return result;
}

std::vector<std::vector<bool>> shared_bins(const std::vector<StageFeatures>& features,
                                           const std::vector<std::vector<std::size_t>>& repeats) {
  std::vector<std::vector<bool>> shared(features.size());
  for (const std::vector<std::size_t>& group : repeats) {
    std::map<std::pair<std::size_t, std::size_t>, int> count;
    for (const std::size_t r : group)
      for (const Bin& bin : features[r].bins) ++count[{bin.channel, bin.span}];
    for (const std::size_t r : group)
      for (const Bin& bin : features[r].bins) shared[r].push_back(count[{bin.channel, bin.span}] > 1);
  }
  return shared;
}

}  // namespace kenaf::gap::diagnose
