#include "gap/diagnose/left_over.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "gap/diagnose/left_over_fit.hpp"
#include "gap/diagnose/left_over_regressors.hpp"
#include "gap/diagnose/left_over_words.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr std::size_t kMostPoints = 400;
constexpr double kAlikeSides =
    0.25;  // largest relative difference of both tracks' slopes (chosen: half of what a repair would change)

// A described term, with the data for comparing both tracks.
struct Said {
  Dependence dependence;
  Quantity quantity;
  LeftOverCandidate on;
  bool of_runs;
};

std::string name_on(const LeftOverCandidate& on, std::string_view channel) {
  const bool of_itself = on.kind == Regressor::simulated || is_late(on.kind);
  return of_itself ? fmt::format("{} {}", on.name, channel) : std::string(on.name);
}

// Drawn evenly from all rows.
std::vector<std::array<double, 2>> points_of(const VectorXd& x, const VectorXd& y) {
  std::vector<std::array<double, 2>> points;
  const auto count = static_cast<std::size_t>(x.size()), kept = std::min(count, kMostPoints);
  for (std::size_t i = 0; i < kept; ++i) {
    const auto row = static_cast<Index>(i * count / kept);
    points.push_back({x[row], y[row]});
  }
  return points;
}

Dependence dependence_of(const LeftOverRows& rows, const LeftOverFit& fit, const LeftOverTerm& term) {
  const LeftOverCandidate& on = rows.candidates[term.candidate];
  Dependence d{std::string(rows.quantity.name), name_on(on, rows.quantity.name),         term.share, term.slope, 0,
               words_of(rows, fit, term),       look_at(rows.quantity.quantity, on.kind)};
  const VectorXd left = left_to(rows, fit, term);
  d.unit = rows.quantity.unit;
  d.on_unit =
      on.kind == Regressor::delay || on.kind == Regressor::lag ? fmt::format("{} / s", d.unit) : std::string(on.unit);
  if (on.kind == Regressor::constant) {
    // drawn over the quantity itself
    d.intercept = term.slope;
    d.slope = 0;
    d.on_unit = d.unit;
    d.points = points_of(rows.simulated, left);
  } else {
    d.points = points_of(rows.x.col(static_cast<Index>(term.candidate)), left);
  }
  return d;
}

Dependence dependence_of(const LeftOverRows& rows, const LeftOverFit& fit, const RunFactor& by_run) {
  Dependence d{
      std::string(rows.quantity.name),         "run", by_run.share, 0, by_run.middle, words_of(rows, fit, by_run),
      look_at_for_runs(rows.quantity.quantity)};
  d.unit = by_run.of_simulated ? "of the simulated" : std::string(rows.quantity.unit);
  for (std::size_t i = 0; i < std::min(by_run.of_run.size(), kMostPoints); ++i) d.points.push_back(by_run.of_run[i]);
  return d;
}

bool is_same_kind(const Said& a, const Said& b) {
  return a.of_runs == b.of_runs && (a.on.kind == b.on.kind || (is_late(a.on.kind) && is_late(b.on.kind)));
}

bool is_alike(const Said& a, const Said& b) {
  if (a.on.kind != b.on.kind) return false;
  const auto number = [](const Said& said) {
    return said.on.kind == Regressor::ramp ? said.on.parameter : said.dependence.slope + said.dependence.intercept;
  };
  return std::abs(number(a) - number(b)) <= kAlikeSides * std::max(std::abs(number(a)), std::abs(number(b)));
}

double share_of(const Said* said) {
  return said == nullptr ? 0 : said->dependence.share;
}

// Joins the terms of both tracks in one sentence.
Said of_each_track(const Said& left, const Said& right) {
  Said both = left.dependence.share < right.dependence.share ? left : right;
  constexpr std::string_view kEach = "speed of each track";
  both.dependence.words.replace(0, both.dependence.channel.size(), kEach);
  both.dependence.channel = kEach;
  return both;
}

// A cause shows in each track and in their mean and difference. It is described for the pair with the larger share; for
// each track separately if they differ or only one has it.
std::vector<Said> without_doubles(const std::vector<Said>& all) {
  // the term of that quantity which says the same, if any
  const auto find = [&](Quantity quantity, const Said& like) {
    const auto found = std::ranges::find_if(
        all, [&](const Said& said) { return said.quantity == quantity && is_same_kind(said, like); });
    return found == all.end() ? nullptr : &*found;
  };
  std::vector<Said> kept;
  for (const Said& said : all) {
    // only terms about tracks have doubles
    const bool of_side = said.quantity == Quantity::left_track || said.quantity == Quantity::right_track;
    const bool of_both = said.quantity == Quantity::track_mean || said.quantity == Quantity::track_difference;
    if (!of_side && !of_both) {
      kept.push_back(said);
      continue;
    }

    // keep the pair with the larger sum of shares; where they are about equal, that of single tracks
    const Said *left = find(Quantity::left_track, said), *right = find(Quantity::right_track, said);
    const Said *mean = find(Quantity::track_mean, said), *difference = find(Quantity::track_difference, said);
    const double by_side = share_of(left) + share_of(right), by_both = share_of(mean) + share_of(difference);
    const bool alike = left != nullptr && right != nullptr && is_alike(*left, *right);
    if (of_side != (by_side >= by_both - 2 * kClearlyMore)) continue;

    // tracks that agree share one sentence, in the place of the left one
    if (of_both || !alike)
      kept.push_back(said);
    else if (&said == left)
      kept.push_back(of_each_track(*left, *right));
  }
  return kept;
}

void check_sizes(const LeftOverRun& run) {
  const auto bins = static_cast<Index>(run.features->bins().size());
  if (run.measured.size() != bins || run.simulated.size() != bins || run.sigma.size() != bins)
    throw std::invalid_argument(fmt::format("{}: as many numbers as bins are needed", run.observation->file));
}

}  // namespace

std::vector<Dependence> describe_left_over(std::span<const LeftOverRun> runs, bool of_drives) {
  std::vector<std::size_t> groups;
  for (const LeftOverRun& run : runs) {
    check_sizes(run);
    groups.push_back(run.group);
  }
  std::vector<Said> all;
  for (const QuantityInfo& quantity : left_over_quantities()) {
    if (quantity.drive != of_drives) continue;
    const LeftOverRows rows = rows_of(runs, quantity);
    if (rows.run.empty()) continue;
    const LeftOverFit fit = fit_left_over(rows, held_out_together(rows, groups));
    for (const LeftOverTerm& term : fit.terms)
      if (term.share >= kLeastReported)
        all.push_back({dependence_of(rows, fit, term), quantity.quantity, rows.candidates[term.candidate], false});
    if (fit.by_run) all.push_back({dependence_of(rows, fit, *fit.by_run), quantity.quantity, {}, true});
  }
  std::vector<Dependence> result;
  for (Said& said : without_doubles(all)) result.push_back(std::move(said.dependence));
  std::ranges::stable_sort(result, std::ranges::greater{}, &Dependence::share);
  return result;
}

}  // namespace kenaf::gap::diagnose
