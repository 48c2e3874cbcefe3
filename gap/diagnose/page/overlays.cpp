#include "gap/diagnose/page/overlays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

#include "gap/candidates/robot_numbers.hpp"
#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/prediction.hpp"
#include "gap/diagnose/repeats.hpp"
#include "gap/diagnose/report_words.hpp"
#include "gap/diagnose/stage_candidates.hpp"
#include "gap/parallel.hpp"

namespace kenaf::gap::diagnose {
namespace {

constexpr std::size_t kMostGroups = 8, kLeastChannels = 2, kMostChannels = 4;
constexpr double kWorthShowing = 0.03;  // minimum share of a manoeuvre's gap for a third and a fourth channel
constexpr double kLongGap_s = 0.5;
// The channels shown if none has a larger gap than the others.
constexpr std::string_view kTelling[] = {"pitch_rad", "yaw_rad", "x_m", "track_left_mps", "track_right_mps"};

// "track_mps" of track_left_mps, "flipper_rad" of flipper_fl_rad.
std::string without_side(std::string_view column) {
  std::string family(column);
  for (const std::string_view side : {"_left", "_right", "_fl", "_fr", "_rl", "_rr"})
    if (const std::size_t at = family.find(std::string(side) + "_"); at != std::string::npos)
      family.erase(at, side.size());
  return family;
}

// [group][channel], share of everything beyond chance in all runs; all 0 if there is nothing, or nothing is known.
std::vector<std::vector<double>> shares_by_group(const Diagnosis& d) {
  std::vector<std::vector<double>> shares(d.repeats.size(), std::vector<double>(diagnosis_channels().size(), 0));
  for (std::size_t s = 0; s < d.stages.size(); ++s) {
    const StageDiagnosis& stage = d.stages[s];
    const double of_stage = share_of_gap(d, s);
    if (of_stage <= 0) continue;
    const Coherence coherence(d.features.of(stage.passage), d.repeats, d.options.stretch_s);
    const std::vector<Cell> cells = cells_that_stand_out(stage.nominal_floor, coherence, stage.residuals);
    double total = 0;
    for (const Cell& cell : cells) total += beyond_chance(cell);
    for (const Cell& cell : cells)
      if (total > 0) shares[cell.group][cell.channel] += of_stage * beyond_chance(cell) / total;
  }
  return shares;
}

bool measured(const runs::Run& run, std::size_t channel) {
  return runs::any_measured(run.column(diagnosis_channels()[channel].column));
}

std::vector<std::size_t> telling_channels(const runs::Run& run, const std::vector<double>& shares) {
  std::vector<std::size_t> sorted;
  for (std::size_t c = 0; c < shares.size(); ++c)
    if (measured(run, c)) sorted.push_back(c);
  const auto preference = [](std::size_t c) {
    return std::ranges::find(kTelling, diagnosis_channels()[c].column) - std::begin(kTelling);
  };
  std::ranges::stable_sort(sorted, [&](std::size_t a, std::size_t b) {
    return shares[a] != shares[b] ? shares[a] > shares[b] : preference(a) < preference(b);
  });
  std::vector<std::size_t> chosen;
  const double worth_showing = kWorthShowing * std::accumulate(shares.begin(), shares.end(), 0.0);
  for (const std::size_t c : sorted) {
    if (chosen.size() == kMostChannels || (chosen.size() >= kLeastChannels && shares[c] <= worth_showing)) break;
    const std::string family = without_side(diagnosis_channels()[c].column);
    if (std::ranges::none_of(
            chosen, [&](std::size_t other) { return without_side(diagnosis_channels()[other].column) == family; }))
      chosen.push_back(c);
  }
  return chosen;
}

}  // namespace

std::vector<std::size_t> shown_groups(const Diagnosis& d) {
  std::vector<double> share(d.repeats.size(), 0);
  for (std::size_t s = 0; s < d.stages.size(); ++s)
    for (const PhaseGap& phase : d.stages[s].where.phases) share[phase.group] += share_of_gap(d, s) * phase.share;
  std::vector<std::size_t> groups(d.repeats.size());
  std::iota(groups.begin(), groups.end(), std::size_t{0});
  std::ranges::stable_sort(groups, [&](std::size_t a, std::size_t b) { return share[a] > share[b]; });
  groups.resize(std::min(groups.size(), kMostGroups));
  std::ranges::sort(groups);
  return groups;
}

void choose_channels(const Diagnosis& d, std::vector<Overlay>& overlays) {
  const std::vector<std::vector<double>> shares = shares_by_group(d);
  for (Overlay& overlay : overlays) {
    overlay.channels = telling_channels(d.observations.runs[overlay.run].run, shares[overlay.group]);
    overlay.shares.clear();
    for (const std::size_t c : overlay.channels) overlay.shares.push_back(shares[overlay.group][c]);
  }
}

std::optional<Variation> corrected_robot(const Diagnosis& d, const Predictor& predictor) {
  Variation corrected = predictor.unvaried();
  const Settings found = corrections(d);
  corrected.robot = with_settings(std::move(corrected.robot), d.candidates, found);
  if (found.empty() || !candidates::why_impossible(corrected.robot).empty()) return std::nullopt;
  return corrected;
}

std::vector<Overlay> simulate_overlays(const Diagnosis& d) {
  std::vector<Overlay> overlays;
  for (const std::size_t group : shown_groups(d))
    overlays.push_back({group, representative(d.observations, d.repeats[group]), {}, {}, {}, std::nullopt});
  const Predictor predictor(d.observations, d.features, d.repeats, 1);
  const std::optional<Variation> corrected = corrected_robot(d, predictor);
  for_each_job(overlays.size(), d.options.jobs, [&](std::size_t i) {
    overlays[i].nominal = predictor.simulate(overlays[i].run, predictor.unvaried());
    if (corrected) overlays[i].corrected = predictor.simulate(overlays[i].run, *corrected);
  });
  choose_channels(d, overlays);
  return overlays;
}

std::vector<plot::Point> over_time(const runs::Run& run, std::size_t channel) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const std::span<const double> time = run.column("t_s"), column = run.column(diagnosis_channels()[channel].column);
  std::vector<plot::Point> points;
  double last_t_s = std::numeric_limits<double>::infinity(), last = 0;
  for (std::size_t i = 0; i < column.size(); ++i) {
    if (std::isnan(column[i])) continue;
    double value = column[i];
    if (diagnosis_channels()[channel].angle && !points.empty()) value -= kTurn * std::round((value - last) / kTurn);
    if (time[i] - last_t_s > kLongGap_s) points.emplace_back(time[i], std::numeric_limits<double>::quiet_NaN());
    points.emplace_back(time[i], value);
    last_t_s = time[i];
    last = value;
  }
  return points;
}

}  // namespace kenaf::gap::diagnose
