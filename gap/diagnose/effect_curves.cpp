#include "gap/diagnose/effect_curves.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>

#include "gap/diagnose/channels.hpp"

namespace kenaf::gap::diagnose {
namespace {

// Fractions of the way from neutral to an end of the range.
constexpr double kSpread[] = {0.25, 1};
// Relative error of numbers in a careful description, as a fraction of Candidate::whole (chosen).
constexpr double kOrdinarilyOff = 0.02;

constexpr double kRoughReach = 2;

// Ratio of a length to that of a straight line: at the outer of two points for a line through the inner one, and vice
// versa.
constexpr double kBent = 2;
constexpr int kHalvings = 4;
constexpr double kInward = 0.25;  // of the way from neutral to the innermost point

// A line between an exact point and a rough one near it has an arbitrary slope. The ends of a curve stay: without them
// no fit could go beyond the exact point.
void forget_rough_points(EffectCurve& curve, double present, double exact_value) {
  const double reach = kRoughReach * (exact_value - present);
  const double first = curve.points.front().value, last = curve.points.back().value;
  std::erase_if(curve.points, [&](const CurvePoint& point) {
    if (point.value == first || point.value == last) return false;
    const double from_present = point.value - present;
    return !point.exact && from_present * reach > 0 && std::abs(from_present) < std::abs(reach);
  });
}

double length_of_column(const EffectCurves& curves, const StageData& data, int column) {
  double squares = 0;
  for (std::size_t g = 0; g < data.groups.size(); ++g)
    squares += (curves.shifts[g].col(column).array().square() / data.groups[g].variance.array()).sum();
  return std::sqrt(squares);
}

// Midpoints of neighbours on one side of the present value between which a bent curve becomes longer than `length`.
std::vector<Setting> halves_of_bends(const EffectCurves& curves, const StageData& data, std::size_t c, double length) {
  std::vector<Setting> halves;
  const std::vector<CurvePoint>& points = curves.curves[c].points;
  const double present = curves.candidates[c].present;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const bool outward = points[i].value > present;
    const CurvePoint &inner = points[outward ? i - 1 : i], &outer = points[outward ? i : i - 1];
    if (inner.column < 0 || outer.column < 0) continue;
    const double inner_length = length_of_column(curves, data, inner.column),
                 outer_length = length_of_column(curves, data, outer.column);
    const double straight = inner_length * (outer.value - present) / (inner.value - present);
    if (inner_length < length && outer_length > std::max(length, kBent * straight))
      halves.push_back({c, (inner.value + outer.value) / 2});
  }
  return halves;
}

// Points inside the innermost point of a side, if that is longer than `length` and the next one not proportionally
// longer: then the effect jumps before the innermost point.
void add_inner(const EffectCurves& curves, const StageData& data, std::size_t c, double length,
               std::vector<Setting>& inner) {
  const std::vector<CurvePoint>& points = curves.curves[c].points;
  const double present = curves.candidates[c].present;
  const std::ptrdiff_t middle = std::ranges::find(points, -1, &CurvePoint::column) - points.begin();
  for (const std::ptrdiff_t outward : {-1, 1}) {
    const std::ptrdiff_t last = middle + 2 * outward;
    if (last < 0 || last >= std::ssize(points)) continue;
    const CurvePoint &first = points[static_cast<std::size_t>(middle + outward)],
                     &second = points[static_cast<std::size_t>(last)];
    const double first_length = length_of_column(curves, data, first.column),
                 second_length = length_of_column(curves, data, second.column);
    const double straight = second_length * (first.value - present) / (second.value - present);
    if (first_length > std::max(length, kBent * straight))
      inner.push_back({c, present + kInward * (first.value - present)});
  }
}

// Points at fractions `parts` of the way from the present value to each end.
std::vector<Setting> parts_of_ranges(const EffectCurves& curves, std::span<const std::size_t> chosen,
                                     std::span<const double> parts) {
  std::vector<Setting> points;
  for (const std::size_t c : chosen) {
    const candidates::Candidate& candidate = curves.candidates[c];
    for (const double end : {candidate.min, candidate.max})
      for (const double part : parts)
        if (const double value = candidate.present + part * (end - candidate.present);
            end != candidate.present && std::ranges::count(curves.curves[c].points, value, &CurvePoint::value) == 0)
          points.push_back({c, value});
  }
  return points;
}

// Length at an end of the range by a straight line: the largest length of a shift per unit of value on that side of the
// present value, or of the other side if it has no points.
double straight_length(const EffectCurves& curves, const StageData& data, std::size_t c, double end) {
  const double present = curves.candidates[c].present;
  std::optional<double> same_side, other_side;
  for (const CurvePoint& point : curves.curves[c].points) {
    if (point.column < 0) continue;
    const double by_value = length_of_column(curves, data, point.column) / std::abs(point.value - present);
    std::optional<double>& longest = (point.value > present) == (end > present) ? same_side : other_side;
    longest = std::max(longest.value_or(0), by_value);
  }
  return (same_side ? *same_side : other_side.value_or(0)) * std::abs(end - present);
}

// Ends of the range where the curve, extrapolated to them, stays shorter than the gap.
std::vector<Setting> ends_of_short_sides(const EffectCurves& curves, const StageData& data,
                                         std::span<const std::size_t> chosen) {
  const double gap = gap_in_noise(data);
  std::vector<Setting> ends;
  for (const std::size_t c : chosen) {
    const candidates::Candidate& candidate = curves.candidates[c];
    for (const double end : {candidate.min, candidate.max})
      if (end != candidate.present && std::ranges::count(curves.curves[c].points, end, &CurvePoint::value) == 0 &&
          straight_length(curves, data, c, end) < gap)
        ends.push_back({c, end});
  }
  return ends;
}

// The upper end of the range; the lower one if there is no range above.
double end_of_range(const candidates::Candidate& candidate) {
  return candidate.max > candidate.present ? candidate.max : candidate.min;
}

}  // namespace

double ordinarily_off(const candidates::Candidate& candidate) {
  const double to_end = end_of_range(candidate) - candidate.present;
  return candidate.present + std::copysign(std::min(kOrdinarilyOff * candidate.whole, std::abs(to_end)), to_end);
}

double squares_in_noise(const StageData& data, const GroupVectors& difference) {
  double squares = 0;
  for (std::size_t g = 0; g < data.groups.size(); ++g)
    squares += (difference[g].array().square() / data.groups[g].variance.array()).sum();
  return squares;
}

double length_in_noise(const StageData& data, const GroupVectors& difference) {
  return std::sqrt(squares_in_noise(data, difference));
}

std::vector<double> squares_of_kinds(const StageData& data, const GroupVectors& difference) {
  std::vector<double> squares(kind_count(), 0);
  for (std::size_t g = 0; g < data.groups.size(); ++g) {
    const StageGroup& group = data.groups[g];
    for (const Series& series : group.series)
      squares[series.kind] +=
          (difference[g].array().square() / group.variance.array()).segment(series.first, series.count).sum();
  }
  return squares;
}

bool acts_in(std::span<const double> squares_of_shift, std::size_t kind) {
  constexpr double kNoSmallPart = 0.05;  // chosen
  return squares_of_shift[kind] >= kNoSmallPart * std::reduce(squares_of_shift.begin(), squares_of_shift.end());
}

double gap_in_noise(const StageData& data) {
  double squares = 0;
  for (const StageGroup& group : data.groups)
    squares += (group.residual.array().square() / group.variance.array()).sum();
  return std::sqrt(squares);
}

bool is_bent(const EffectCurves& curves, const StageData& data, std::size_t c, double length) {
  return !halves_of_bends(curves, data, c, length).empty();
}

EffectCurves empty_curves(const StageData& data, std::span<const candidates::Candidate> candidates) {
  EffectCurves curves{candidates, {}, {}};
  for (std::size_t c = 0; c < candidates.size(); ++c)
    curves.curves.push_back({c, {{candidates[c].present, -1, true}}, 0});
  for (const StageGroup& group : data.groups) curves.shifts.emplace_back(std::ssize(group.bins), 0);
  return curves;
}

void forget_all_but(EffectCurves& curves, std::span<const std::size_t> kept) {
  for (EffectCurve& curve : curves.curves) {
    if (std::ranges::count(kept, curve.candidate) > 0) continue;
    std::erase_if(curve.points, [](const CurvePoint& point) { return point.column >= 0; });
    curve.visible = 0;
  }
}

void add_spread(EffectCurves& curves, const StageData& data, std::span<const std::size_t> chosen,
                const Simulate& simulate) {
  add_points(curves, data, parts_of_ranges(curves, chosen, kSpread), Fidelity::coarse, simulate);
}

void add_first_look(EffectCurves& curves, const StageData& data, std::span<const std::size_t> chosen,
                    const Simulate& simulate) {
  std::vector<Setting> points;
  for (const std::size_t c : chosen) {
    const candidates::Candidate& candidate = curves.candidates[c];
    const bool both_ways = candidate.min < candidate.present && candidate.present < candidate.max;
    const double end = end_of_range(candidate);
    points.push_back({c, candidate.whole > 0 ? ordinarily_off(candidate)
                                             : candidate.present + kSpread[0] * (end - candidate.present)});
    // an effect with a threshold (drives that stall) shows only farther out, and hides the other side
    if (!both_ways)
      points.push_back({c, end});
    else if (candidate.whole == 0)
      points.push_back({c, candidate.present + kSpread[0] * (candidate.min - candidate.present)});
  }
  add_points(curves, data, points, Fidelity::coarse, simulate);

  // what a number does to the gap shows at a quarter of its range, if not only at its end
  const double gap = gap_in_noise(data);
  points = ends_of_short_sides(curves, data, chosen);
  for (const std::size_t c : chosen) {
    const candidates::Candidate& candidate = curves.candidates[c];
    const double end = end_of_range(candidate);
    if (candidate.whole > 0 && straight_length(curves, data, c, end) >= gap)
      points.push_back({c, candidate.present + kSpread[0] * (end - candidate.present)});
  }
  add_points(curves, data, points, Fidelity::coarse, simulate);
}

void follow_bends(EffectCurves& curves, const StageData& data, std::span<const std::size_t> chosen,
                  const Simulate& simulate) {
  const double gap = gap_in_noise(data);
  for (int i = 0; i < kHalvings; ++i) {
    std::vector<Setting> points;
    for (const std::size_t c : chosen) {
      std::ranges::copy(halves_of_bends(curves, data, c, gap), std::back_inserter(points));
      add_inner(curves, data, c, gap, points);
    }
    if (points.empty()) return;
    add_points(curves, data, points, Fidelity::coarse, simulate);
  }
}

void add_points(EffectCurves& curves, const StageData& data, std::span<const Setting> points, Fidelity fidelity,
                const Simulate& simulate) {
  if (points.empty()) return;
  std::vector<Settings> asked;
  for (const Setting& point : points) asked.push_back({point});
  insert_points(curves, data, points, simulate(asked, fidelity), fidelity);
}

void insert_points(EffectCurves& curves, const StageData& data, std::span<const Setting> points,
                   const std::vector<GroupVectors>& shifts, Fidelity fidelity) {
  const auto first = static_cast<int>(curves.shifts.front().cols());
  for (std::size_t g = 0; g < curves.shifts.size(); ++g) {
    curves.shifts[g].conservativeResize(Eigen::NoChange, first + std::ssize(points));
    for (std::size_t p = 0; p < points.size(); ++p)
      curves.shifts[g].col(first + static_cast<Eigen::Index>(p)) = shifts[p][g];
  }
  for (std::size_t p = 0; p < points.size(); ++p) {
    EffectCurve& curve = curves.curves[points[p].candidate];
    const CurvePoint added{points[p].value, first + static_cast<int>(p), fidelity != Fidelity::coarse};
    if (added.exact) forget_rough_points(curve, curves.candidates[curve.candidate].present, added.value);
    const auto place = std::ranges::lower_bound(curve.points, added.value, {}, &CurvePoint::value);
    if (place != curve.points.end() && place->value == added.value)
      *place = added;
    else
      curve.points.insert(place, added);
    curve.visible = std::max(curve.visible, length_of_column(curves, data, added.column));
  }
}

}  // namespace kenaf::gap::diagnose
