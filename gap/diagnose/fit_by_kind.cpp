#include "gap/diagnose/fit_by_kind.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gap/diagnose/channels.hpp"

namespace kenaf::gap::diagnose {
namespace {

// An effect should explain a kind of channels in which it acts if its shift is at least this share of the gap there,
// rms (chosen).
constexpr double kShouldExplain = 0.5;
// Residuals below this multiple of the noise are not coherent enough to blame an effect for (chosen): noise with a
// memory is not independent in neighbouring bins.
constexpr double kOfNoise = 2;

std::vector<double> bins_of_kinds(const StageData& data) {
  std::vector<double> bins(kind_count(), 0);
  for (const StageGroup& group : data.groups)
    for (const Series& series : group.series) bins[series.kind] += static_cast<double>(series.count);
  return bins;
}

StageData with_kind_alone(StageData data, std::size_t kind) {
  for (StageGroup& group : data.groups)
    for (const Series& series : group.series)
      if (series.kind != kind) group.variance.segment(series.first, series.count).setConstant(kVarianceIfUnused);
  return data;
}

}  // namespace

std::vector<FitByKind> fit_by_kind(const StageData& data, const StandingModel& standing, const GroupVectors& left,
                                   double borne_out) {
  const Model& model = standing.model;
  const Discrepancies& discrepancies = model.likelihood.discrepancies;
  std::vector<FitByKind> fits(model.places.size());
  const std::vector<double> bins = bins_of_kinds(data), squares_left = squares_of_kinds(data, left),
                            squares_of_gap =
                                squares_of_kinds(data, without_open_shapes(data, residuals_of(data), discrepancies));

  // each effect's own shift, and the kinds that it should explain
  std::vector<GroupVectors> own;
  std::vector<std::vector<double>> squares_of_own;
  for (const OnCurve& place : model.places) {
    own.push_back(shift_of(standing.curves, {&place, 1}));
    squares_of_own.push_back(squares_of_kinds(data, own.back()));
  }
  const auto should_explain = [&](std::size_t effect, std::size_t kind) {
    const std::vector<double>& squares = squares_of_own[effect];
    return squares[kind] > kShouldExplain * kShouldExplain * squares_of_gap[kind] && acts_in(squares, kind);
  };

  // what is left, beside that shift
  for (std::size_t e = 0; e < fits.size(); ++e)
    for (std::size_t k = 0; k < kind_count(); ++k) {
      const double coherent = squares_left[k] - kOfNoise * kOfNoise * bins[k];
      if (!should_explain(e, k) || !(coherent > 0)) continue;
      const double share = std::sqrt(coherent / squares_of_own[e][k]);
      if (share > fits[e].left) fits[e].left = share, fits[e].left_in = k;
    }

  // the value that each kind wants, the other effects as they are
  for (std::size_t k = 0; k < kind_count(); ++k) {
    std::vector<std::size_t> shown;
    for (std::size_t e = 0; e < fits.size(); ++e)
      if (bins[k] > 0 && should_explain(e, k) && squares_of_own[e][k] >= bins[k]) shown.push_back(e);
    if (shown.empty()) continue;
    const StageData alone = with_kind_alone(data, k);
    const double common = likelihood_with(alone, rest_of(data, model), discrepancies).deviance;
    for (const std::size_t e : shown) {
      const OnCurve& place = model.places[e];
      const Model wanted = fit_values(alone, standing.curves, std::vector<std::size_t>{place.curve},
                                      less(model.shift, own[e]), discrepancies);
      if (common - wanted.deviance() < borne_out) continue;
      const double value =
          wanted.places.empty() ? standing.curves.candidates[place.curve].present : wanted.places.front().value;
      const double apart = std::abs(value - place.value);
      if (apart > fits[e].apart) fits[e].apart = apart, fits[e].apart_in = k;
    }
  }
  return fits;
}

}  // namespace kenaf::gap::diagnose
