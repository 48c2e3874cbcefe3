#include "gap/diagnose/left_over.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "gap/diagnose/left_over_fit.hpp"
#include "gap/diagnose/left_over_regressors.hpp"
#include "gap/diagnose/left_over_words.hpp"

namespace kenaf::gap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr std::size_t kMostPoints = 400;
constexpr double kAlikeSides =
    0.25;  // by which slopes of both tracks differ at most (chosen: half of what a repair would be)

// A term that was said, with what comparing both tracks needs.
struct Said {
  Dependence dependence;
  Quantity quantity;
  Regressor on;
};

std::string name_on(const Candidate& on, std::string_view channel) {
  const bool of_itself = on.kind == Regressor::simulated || is_late(on.kind);
  return of_itself ? fmt::format("{} {}", on.name, channel) : std::string(on.name);
}

// Evenly drawn from all rows.
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
  const Candidate& on = rows.candidates[term.candidate];
  Dependence d{std::string(rows.quantity.name), name_on(on, rows.quantity.name),         term.share, term.slope, 0,
               words_of(rows, fit, term),       look_at(rows.quantity.quantity, on.kind)};
  const VectorXd left = left_to(rows, fit, term);
  d.unit = rows.quantity.unit;
  d.on_unit =
      on.kind == Regressor::delay || on.kind == Regressor::lag ? fmt::format("{} / s", d.unit) : std::string(on.unit);
  if (on.kind == Regressor::constant) {
    // nothing to draw it over but the quantity itself
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

bool is_same_kind(Regressor a, Regressor b) {
  return a == b || (is_late(a) && is_late(b));
}

// Limits of two tracks have no slopes to compare; other terms do.
bool is_alike(const Said& a, const Said& b) {
  if (a.on != b.on || a.on == Regressor::ramp) return true;
  const double of_a = a.dependence.slope + a.dependence.intercept, of_b = b.dependence.slope + b.dependence.intercept;
  return std::abs(of_a - of_b) <= kAlikeSides * std::max(std::abs(of_a), std::abs(of_b));
}

// Where both tracks say the same, their mean or difference says it for them; where one has what the other has not, it
// is that track's, and mean and difference say half of it each.
std::vector<Said> without_doubles(const std::vector<Said>& all) {
  const auto find = [&](Quantity quantity, const Said& like) {
    const bool of_runs = like.dependence.on == "run";
    const auto found = std::ranges::find_if(all, [&](const Said& said) {
      return said.quantity == quantity && is_same_kind(said.on, like.on) && (said.dependence.on == "run") == of_runs;
    });
    return found == all.end() ? nullptr : &*found;
  };
  std::vector<Said> kept;
  for (const Said& said : all) {
    const bool of_side = said.quantity == Quantity::left_track || said.quantity == Quantity::right_track;
    const bool of_both = said.quantity == Quantity::track_mean || said.quantity == Quantity::track_difference;
    const Said *left = find(Quantity::left_track, said), *right = find(Quantity::right_track, said);
    const bool told_by_both = find(Quantity::track_mean, said) || find(Quantity::track_difference, said);
    const bool same = left != nullptr && right != nullptr && is_alike(*left, *right);
    if (of_side && told_by_both && (same || said.dependence.on == "run")) continue;
    const Said* alone = left == nullptr ? right : right == nullptr ? left : nullptr;
    if (of_both && alone != nullptr && alone->dependence.share > said.dependence.share) continue;
    kept.push_back(said);
  }
  return kept;
}

void check_sizes(const LeftOverRun& run) {
  const auto bins = static_cast<Index>(run.features->bins().size());
  if (run.measured.size() != bins || run.simulated.size() != bins || run.sigma.size() != bins)
    throw std::invalid_argument(fmt::format("{}: as many numbers as bins are needed", run.observation->file));
}

}  // namespace

std::vector<Dependence> describe_left_over(std::span<const LeftOverRun> runs, bool only_drives) {
  std::vector<std::size_t> groups;
  for (const LeftOverRun& run : runs) {
    check_sizes(run);
    groups.push_back(run.group);
  }
  std::vector<Said> all;
  for (const QuantityInfo& quantity : left_over_quantities()) {
    if (only_drives && !quantity.drive) continue;
    const LeftOverRows rows = rows_of(runs, quantity);
    if (rows.run.empty()) continue;
    const LeftOverFit fit = fit_left_over(rows, held_out_together(rows, groups));
    for (const LeftOverTerm& term : fit.terms)
      if (term.share >= kLeastTold)
        all.push_back({dependence_of(rows, fit, term), quantity.quantity, rows.candidates[term.candidate].kind});
    if (fit.by_run) all.push_back({dependence_of(rows, fit, *fit.by_run), quantity.quantity, Regressor::simulated});
  }
  std::vector<Dependence> told;
  for (Said& said : without_doubles(all)) told.push_back(std::move(said.dependence));
  std::ranges::stable_sort(told, std::ranges::greater{}, &Dependence::share);
  return told;
}

}  // namespace kenaf::gap
