#include "gap/diagnose/left_over_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Two numbers count as equal if they differ by less than a quarter of the described slope, or by less than 0.05
// (chosen).
constexpr double kSameShare = 0.25, kSameRatio = 0.05;
constexpr double kOneSided = 1.0 / 3;  // of the other side's slope: smaller ones count as none (chosen)
constexpr double kNearlyEvery = 0.9;   // of the runs: least share for "in nearly every run" (chosen)
constexpr double kMost = 2.0 / 3;      // of the runs: least share for "in most runs" (chosen)
constexpr double kSpeedsDiffer = 1.5;  // ratio of the 90 % and 10 % quantiles: below it there is one speed (chosen)

bool turns(Quantity quantity) {
  return quantity == Quantity::yaw_rate || quantity == Quantity::gyro;
}

// A term with its rows, for comparing subsets.
struct TermRows {
  const LeftOverRows& rows;
  VectorXd x, y;
  const VectorXd& weights;
  double slope;

  std::size_t size() const { return rows.run.size(); }
  // Slope over the rows for which `holds`.
  template <class Holds>
  double slope_where(Holds&& holds) const {
    std::vector<bool> chosen(size());
    for (std::size_t i = 0; i < size(); ++i) chosen[i] = holds(static_cast<Index>(i));
    return slope_through_zero(x, y, weights, chosen);
  }
  // Their share in the sum of squares of x.
  template <class Holds>
  double part_where(Holds&& holds) const {
    double part = 0;
    for (Index i = 0; i < x.size(); ++i)
      if (holds(i)) part += x[i] * x[i];
    return part / std::max(1e-300, x.squaredNorm());
  }
};

TermRows rows_of_term(const LeftOverRows& rows, const LeftOverFit& fit, const LeftOverTerm& term) {
  return {rows, rows.x.col(static_cast<Index>(term.candidate)), left_to(rows, fit, term), fit.weights, term.slope};
}

// The same plus the term of the quantity's absolute value: on each side it is part of the measured fraction.
TermRows with_size(const LeftOverRows& rows, const LeftOverFit& fit, const TermRows& term) {
  TermRows result = term;
  for (const LeftOverTerm& other : fit.terms)
    if (rows.candidates[other.candidate].kind == Regressor::turn_size && turns(rows.quantity.quantity))
      result.y += other.slope * rows.x.col(static_cast<Index>(other.candidate));
  return result;
}

// Share of the runs that show the term whose own slope has the term's sign.
double share_of_runs(const TermRows& term) {
  std::vector<double> square(term.rows.runs, 0), product(term.rows.runs, 0), shown;
  for (std::size_t i = 0; i < term.size(); ++i) {
    const auto row = static_cast<Index>(i);
    square[term.rows.run[i]] += term.x[row] * term.x[row];
    product[term.rows.run[i]] += term.x[row] * term.y[row];
  }
  for (const double value : square)
    if (value > 0) shown.push_back(value);
  const double enough = quantile_of(shown, 0.5) / 4;
  double same = 0, all = 0;
  for (std::size_t r = 0; r < square.size(); ++r) {
    if (square[r] < enough || square[r] <= 0) continue;
    ++all;
    if (product[r] * term.slope > 0) ++same;
  }
  return all > 1 ? same / all : 1;
}

std::string in_runs(const TermRows& term) {
  const std::string_view what = turns(term.rows.quantity.quantity) ? "turn" : "run";
  if (term.rows.runs < 2 && what == "run") return "";
  const double share = share_of_runs(term);
  if (share >= 1) return fmt::format(", in every {}", what);
  if (share >= kNearlyEvery) return fmt::format(", in nearly every {}", what);
  return share >= kMost ? fmt::format(", in most {}s", what)
                        : fmt::format(", in {:.0f} % of the {}s", 100 * share, what);
}

bool nearly_equal(double a, double b, double slope) {
  return std::abs(a - b) <= std::max(kSameRatio, kSameShare * std::abs(slope));
}

// Compares both directions of motion.
std::string by_side(const TermRows& term) {
  const auto left = [&](Index i) { return term.x[i] > 0; };
  const auto right = [&](Index i) { return term.x[i] < 0; };
  if (std::min(term.part_where(left), term.part_where(right)) < 0.05) return "";  // chosen: hardly any to one side
  const double of_left = term.slope_where(left), of_right = term.slope_where(right);
  if (nearly_equal(of_left, of_right, term.slope)) return "";
  return turns(term.rows.quantity.quantity)
             ? fmt::format(", {:.2f} to the left and {:.2f} to the right", 1 + of_left, 1 + of_right)
             : fmt::format(", {:.2f} forward and {:.2f} backward", 1 + of_left, 1 + of_right);
}

std::string at_speeds(const TermRows& term) {
  const double rms = std::sqrt(term.x.squaredNorm() / static_cast<double>(term.x.size()));
  std::vector<double> speeds;
  const auto matters = [&](Index i) { return std::abs(term.x[i]) > rms / 2 && std::isfinite(term.rows.speed_mps[i]); };
  for (Index i = 0; i < term.x.size(); ++i)
    if (matters(i)) speeds.push_back(term.rows.speed_mps[i]);
  if (speeds.size() < 8) return "";  // chosen: too few for a slope of each half
  if (quantile_of(speeds, 0.9) < kSpeedsDiffer * quantile_of(speeds, 0.1)) return "";
  const double middle = quantile_of(speeds, 0.5);
  const double slow = term.slope_where([&](Index i) { return matters(i) && term.rows.speed_mps[i] <= middle; });
  const double fast = term.slope_where([&](Index i) { return matters(i) && term.rows.speed_mps[i] > middle; });
  if (nearly_equal(slow, fast, term.slope)) return ", at all speeds";
  return fmt::format(", {:.2f} where the tracks run slower than {:.2g} m/s and {:.2f} where faster", 1 + slow, middle,
                     1 + fast);
}

// Compares changes that increase and decrease the simulated quantity's absolute value.
std::string while_changing(const TermRows& term) {
  const auto grows = [&](Index i) { return term.x[i] * term.rows.simulated[i] > 0; };
  const auto shrinks = [&](Index i) { return term.x[i] * term.rows.simulated[i] < 0; };
  if (std::min(term.part_where(grows), term.part_where(shrinks)) < 0.05) return "";
  const double up = term.slope_where(grows) / term.slope, down = term.slope_where(shrinks) / term.slope;
  if (down < kOneSided * up) return ", only while it grows";
  if (up < kOneSided * down) return ", only while it falls";
  return ", whenever it changes";
}

std::string more_or_less(double slope) {
  return slope > 0 ? "more" : "less";
}

std::string sentence(const TermRows& term, const LeftOverFit& fit, const LeftOverTerm& of) {
  const LeftOverCandidate& on = term.rows.candidates[of.candidate];
  const std::string_view unit = term.rows.quantity.unit;
  const double late = lateness(term.rows, fit.terms, of), slope = term.slope;
  // by kind of regressor; a slope s of the simulated quantity itself means that 1 + s of it was measured
  switch (on.kind) {
    case Regressor::simulated:
      return fmt::format("measured {:.2f} of the simulated{}{}{}", 1 + slope, in_runs(term),
                         by_side(with_size(term.rows, fit, term)), at_speeds(term));
    case Regressor::delay:
      return fmt::format("measured {:.2g} s {} the simulated{}", std::abs(late), late > 0 ? "late behind" : "ahead of",
                         while_changing(term));
    case Regressor::lag:
      return late > 0 ? fmt::format("measured about {:.2g} s late behind the simulated, as by a lag{}", late,
                                    while_changing(term))
                      : fmt::format("measured about {:.2g} s ahead of the simulated, as if it lagged less{}", -late,
                                    while_changing(term));
    case Regressor::ramp:
      return fmt::format("measured late behind the simulated, as by a limit of {:.2g} m/s2{}", on.parameter,
                         while_changing(term));
    case Regressor::constant:
      return fmt::format("measured {:.2g} {} {} than the simulated{}", std::abs(slope), unit, more_or_less(slope),
                         in_runs(term));
    case Regressor::direction:
      return fmt::format("measured {:.2g} {} {} in size than the simulated, whatever its size{}", std::abs(slope), unit,
                         more_or_less(slope), in_runs(term));
    case Regressor::acceleration:
      if (unit == "m/s" && slope < 0 && term.rows.quantity.quantity == Quantity::forward)
        return fmt::format(
            "measured less than the simulated by {0:.2g} m/s for each m/s2 of forward acceleration, as if {0:.2g} s "
            "late{1}",
            -slope, in_runs(term));
      [[fallthrough]];
    default:
      return fmt::format("measured {} than the simulated by {:.2g} {} for each {} of {}{}", more_or_less(slope),
                         std::abs(slope), unit, on.unit, on.name, in_runs(term));
  }
}

}  // namespace

VectorXd left_to(const LeftOverRows& rows, const LeftOverFit& fit, const LeftOverTerm& term) {
  return fit.rest + term.slope * rows.x.col(static_cast<Index>(term.candidate));
}

std::string words_of(const LeftOverRows& rows, const LeftOverFit& fit, const LeftOverTerm& term) {
  return fmt::format("{}: {} ({:.0f} % of what is left)", rows.quantity.name,
                     sentence(rows_of_term(rows, fit, term), fit, term), 100 * term.share);
}

std::string words_of(const LeftOverRows& rows, const LeftOverFit& fit, const RunFactor& by_run) {
  double common = 0;
  for (const LeftOverTerm& term : fit.terms) common += term.share;
  const std::string_view most = by_run.share > common ? "most of it differs" : "differs";
  const std::string what =
      by_run.of_simulated
          ? fmt::format("{:.2f} to {:.2f} of the simulated was measured", by_run.low, by_run.high)
          : fmt::format("measured minus simulated is {:.2g} to {:.2g} {}", by_run.low, by_run.high, rows.quantity.unit);
  return fmt::format("{}: {} from run to run: {} in the middle 80 % ({:.0f} % of what is left)", rows.quantity.name,
                     most, what, 100 * by_run.share);
}

}  // namespace kenaf::gap::diagnose
