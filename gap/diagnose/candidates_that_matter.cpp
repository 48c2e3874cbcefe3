#include "gap/diagnose/candidates_that_matter.hpp"

#include <algorithm>
#include <functional>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/curve_fit.hpp"
#include "gap/diagnose/model_search.hpp"

namespace kenaf::gap::diagnose {
namespace {

// All chosen.
constexpr std::size_t kMostCurves = 24;  // candidates taken for their share of the whole gap
constexpr double kMatters = 0.01;        // of the whole squared gap, least share of such a candidate
constexpr std::size_t kMostOfKind = 3;   // candidates taken for their share of the gap in one kind of channels
constexpr double kMattersInKind = 0.2;   // of the squared gap there, least share of such a candidate
constexpr double kLeastGain = 4;         // of chi-squared: two sigma

struct Explained {
  double share;
  std::size_t candidate;
};

// Inner products of one point's shift with itself and with the gap.
struct AlongGap {
  double squares = 0, along = 0;
  // The share of a squared gap `gap` that the shift explains at its best amount: along^2 / squares / gap.
  double share_of(double gap) const { return squares > 0 && gap > 0 ? along * along / squares / gap : 0; }
};

// The first `most` by share, each candidate once.
void add_best(std::vector<Explained> explained, std::size_t most, std::vector<std::size_t>& chosen) {
  std::ranges::stable_sort(explained, std::ranges::greater{}, &Explained::share);
  std::vector<std::size_t> best;
  for (const Explained& one : explained)
    if (best.size() < most && std::ranges::count(best, one.candidate) == 0) best.push_back(one.candidate);
  chosen.insert(chosen.end(), best.begin(), best.end());
}

// `share` of each simulated point, if at least `least`.
std::vector<Explained> explained_by_points(const EffectCurves& curves, std::span<const std::size_t> looked_at,
                                           double least, const std::function<double(int column)>& share) {
  std::vector<Explained> explained;
  for (const std::size_t c : looked_at)
    for (const CurvePoint& point : curves.curves[c].points) {
      if (point.column < 0) continue;
      if (const double part = share(point.column); part >= least) explained.push_back({part, c});
    }
  return explained;
}

AlongGap in_noise(const StageData& data, const EffectCurves& curves, std::size_t kind, int column) {
  AlongGap result;
  for (std::size_t g = 0; g < data.groups.size(); ++g)
    for (const Series& series : data.groups[g].series) {
      if (series.kind != kind) continue;
      const auto weight = data.groups[g].variance.segment(series.first, series.count).array().inverse();
      const auto shift = curves.shifts[g].col(column).segment(series.first, series.count).array();
      const auto gap = data.groups[g].residual.segment(series.first, series.count).array();
      result.squares += (shift * shift * weight).sum();
      result.along += (shift * gap * weight).sum();
    }
  return result;
}

double squared_gap_in_noise(const StageData& data, std::size_t kind) {
  double squares = 0;
  for (const StageGroup& group : data.groups)
    for (const Series& series : group.series)
      if (series.kind == kind)
        squares += (group.residual.segment(series.first, series.count).array().square() /
                    group.variance.segment(series.first, series.count).array())
                       .sum();
  return squares;
}

}  // namespace

std::vector<std::size_t> candidates_that_matter(const StageData& data, const EffectCurves& curves,
                                                std::span<const std::size_t> looked_at,
                                                const Discrepancies& discrepancies) {
  std::vector<std::size_t> matter;
  // a shift s, scaled freely, explains (s'C^-1 r)^2 / (s'C^-1 s) of the gap r'C^-1 r; C: covariance with the
  // discrepancies
  const Products products = products_of(whiteners_of(data, discrepancies), curves.shifts, residuals_of(data));
  add_best(
      explained_by_points(curves, looked_at, std::max(kMatters, kLeastGain / products.gap_gap),
                          [&](int column) {
                            return AlongGap{products.shift_shift(column, column), products.shift_gap[column]}.share_of(
                                products.gap_gap);
                          }),
      kMostCurves, matter);

  // the same for each kind of channels, with C as noise alone
  for (std::size_t kind = 0; kind < kind_count(); ++kind) {
    const double gap = squared_gap_in_noise(data, kind);
    add_best(explained_by_points(curves, looked_at, kMattersInKind,
                                 [&](int column) { return in_noise(data, curves, kind, column).share_of(gap); }),
             kMostOfKind, matter);
  }

  // those that act only far out (a dead band), which no linear step shows
  const double gap = gap_in_noise(data);
  for (const std::size_t c : looked_at)
    if (is_bent(curves, data, c, gap)) matter.push_back(c);

  // each once, in order
  std::ranges::sort(matter);
  matter.erase(std::unique(matter.begin(), matter.end()), matter.end());
  return matter;
}

}  // namespace kenaf::gap::diagnose
