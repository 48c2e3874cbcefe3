#include "gap/diagnose/model_search.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace kenaf::gap {
namespace {

using Eigen::VectorXd;

// In floors: a fit that moves less than this from a simulated point has nothing to learn from another one.
constexpr double kSamePoint = 0.5;
// Of the way from neutral: a curve is known on either side of a fit at these factors, one after the other, so that its
// bend there is.
constexpr double kBrackets[] = {1.5, 1.1, 1.03};
constexpr double kNear = 0.3;  // of the way to one of these
// Sets that are simulated, for each contender: sums of curves rank roughly.
constexpr std::size_t kSetsForAContender = 2;

// The gap less what a simulation of the model had beyond the sum of its curves.
Whitened gap_around(const EffectCurves& curves, const Model& model) {
  Whitened gap = whitened_difference(curves, model.shift, shift_of(curves, model.places));
  for (std::size_t r = 0; r < gap.size(); ++r) gap[r] = curves.gap[r] - gap[r];
  return gap;
}

struct Singles {
  Products products;
  std::vector<CurveFit> fits;  // best first
};

Singles fit_singles(const EffectCurves& curves) {
  Singles singles{products_of(curves, curves.gap), {}};
  for (std::size_t c = 0; c < curves.curves.size(); ++c)
    singles.fits.push_back(fit_one(singles.products, curves.curves, c));
  std::ranges::stable_sort(singles.fits, {}, &CurveFit::left);
  return singles;
}

// Of the shift at a place.
double length_of(const Products& products, const OnCurve& place) {
  Products nothing = products;
  nothing.gap_gap = 0;
  nothing.shift_gap.setZero();
  return std::sqrt(std::max(0.0, left_with(nothing, {&place, 1})));
}

// Whether the place is at a point of its curve that was simulated like this.
bool at_point(const EffectCurve& curve, const OnCurve& place, const Products& products, Fidelity fidelity) {
  const auto dot = [&](int i, int j) { return i < 0 || j < 0 ? 0 : products.shift_shift(i, j); };
  const int a = place.column[0], b = place.column[1];
  const double segment = std::sqrt(std::max(0.0, dot(a, a) - 2 * dot(a, b) + dot(b, b)));
  return std::ranges::any_of(curve.points, [&](const CurvePoint& point) {
    if (fidelity == Fidelity::every_run && !point.exact) return false;
    return (point.column == a && place.weight[1] * segment <= kSamePoint) ||
           (point.column == b && place.weight[0] * segment <= kSamePoint);
  });
}

// How many of the first ones are near enough to the best one to overtake it.
std::size_t near_best(const std::vector<CurveFit>& fits, double nothing_explained, const SearchSettings& settings) {
  const double limit = fits.front().left + settings.near * (nothing_explained - fits.front().left);
  std::size_t count = 0;
  while (count < std::min(settings.finalists, fits.size()) && fits[count].left <= limit) ++count;
  return count;
}

// Between neighbours that were simulated in every run a rough point would only disturb.
bool is_between_exact(const EffectCurve& curve, double value) {
  const auto above = std::ranges::lower_bound(curve.points, value, {}, &CurvePoint::value);
  return above != curve.points.begin() && above != curve.points.end() && above->exact && std::prev(above)->exact;
}

// The value of the simulated point that is nearest to a place.
double nearest_point(const EffectCurve& curve, const OnCurve& place) {
  const int column = place.column[place.weight[1] > place.weight[0] ? 1 : 0];
  return std::ranges::find(curve.points, column, &CurvePoint::column)->value;
}

// Values on either side of one at which an effect fits: a curve may bend, and a straight line to a point far away would
// hide where it goes, so that fits creep along it. Only where there is no point yet.
std::vector<double> bracket(const EffectCurve& curve, double value, Fidelity fidelity) {
  const double neutral = present_value(curve);
  // a point next to the value says nothing of where the curve goes
  const auto is_known = [&](double wanted) {
    const double near = value + kNear * (wanted - value);
    return std::ranges::any_of(curve.points, [&](const CurvePoint& point) {
      return (point.exact || fidelity != Fidelity::every_run) && point.value >= std::min(near, wanted) &&
             point.value <= std::max(near, wanted);
    });
  };
  std::vector<double> values;
  for (const double bracket : kBrackets) {
    for (const double factor : {1 / bracket, bracket}) {
      const double wanted =
          std::clamp(neutral + factor * (value - neutral), curve.parameter->min, curve.parameter->max);
      if (wanted != value && !is_known(wanted)) values.push_back(wanted);
    }
    if (!values.empty() || fidelity != Fidelity::every_run) break;
  }
  return values;
}

// Points where the first `count` of them fit, and on either side of it; false: all of these are there.
bool refine(EffectCurves& curves, const Singles& singles, std::size_t count, Fidelity fidelity,
            const Simulator& simulator) {
  std::vector<NewPoint> points;
  for (std::size_t i = 0; i < std::min(count, singles.fits.size()); ++i) {
    const OnCurve& place = singles.fits[i].places.front();
    const EffectCurve& curve = curves.curves[place.curve];
    if (length_of(singles.products, place) <= kSamePoint) continue;  // as good as neutral
    if (fidelity != Fidelity::every_run && is_between_exact(curve, place.value)) continue;
    const bool stands = at_point(curve, place, singles.products, fidelity);
    const double at = stands ? nearest_point(curve, place) : place.value;
    if (!stands) points.push_back({place.curve, at});
    for (const double value : bracket(curve, at, fidelity)) points.push_back({place.curve, value});
  }
  if (!points.empty()) simulator.add_points(curves, points, fidelity);
  return !points.empty();
}

bool is_visible(const EffectCurve& curve) {
  return curve.visible > 1;
}

// Fits of sets, each with what the last simulation of it lacked to the sum of its curves.
class Sets {
 public:
  Sets(const EffectCurves& curves, std::vector<EffectSet> sets, std::size_t count, double to_beat) : curves_(curves) {
    const Products products = products_of(curves, curves.gap);
    for (EffectSet& set : sets)
      if (CurveFit fit = fit_together(products, curves.curves, set); fit.left < to_beat)
        fits_.push_back({std::move(set), std::move(fit), {}});
    keep_best(count);
  }

  void keep_best(std::size_t count) {
    std::ranges::stable_sort(fits_, {}, &Candidate::left);
    fits_.resize(std::min(fits_.size(), count));
  }

  // Simulates all at the values where they fit, and fits them again.
  void simulate(Fidelity fidelity, const Simulator& simulator) {
    std::vector<std::vector<NewPoint>> asked;
    for (const Candidate& candidate : fits_) asked.push_back(values_of(candidate.fit.places));
    std::vector<Shift> shifts = simulator.shifts(asked, fidelity);
    for (std::size_t i = 0; i < fits_.size(); ++i) {
      Candidate& candidate = fits_[i];
      Model simulated{candidate.fit.places, shifts[i], true};
      simulated.left = squared_length(whitened_difference(curves_, curves_.residual, shifts[i]));
      const Products around = products_around(curves_, simulated);
      if (fidelity == Fidelity::every_run && (!candidate.best.exact || simulated.left < candidate.best.left))
        candidate.best = std::move(simulated);
      candidate.fit = fit_together(around, curves_.curves, candidate.set);
    }
  }

  std::size_t near_best(double nothing_explained, const SearchSettings& settings) {
    std::vector<CurveFit> fits;
    for (const Candidate& candidate : fits_) fits.push_back(candidate.fit);
    return fits.empty() ? 0 : gap::near_best(fits, nothing_explained, settings);
  }

  std::vector<Model> models() const {
    std::vector<Model> models;
    for (const Candidate& candidate : fits_)
      if (candidate.best.exact) models.push_back(candidate.best);
    return models;
  }

 private:
  struct Candidate {
    EffectSet set;
    CurveFit fit;
    Model best;  // of those simulated
    double left() const { return fit.left; }
  };
  const EffectCurves& curves_;
  std::vector<Candidate> fits_;
};

}  // namespace

std::vector<NewPoint> values_of(const std::vector<OnCurve>& places) {
  std::vector<NewPoint> values;
  for (const OnCurve& place : places) values.push_back({place.curve, place.value});
  return values;
}

EffectSet effects_of(const Model& model) {
  EffectSet effects;
  for (const OnCurve& place : model.places) effects.push_back(place.curve);
  return effects;
}

Shift shift_of(const EffectCurves& curves, std::span<const OnCurve> places) {
  Shift shift;
  for (const Eigen::MatrixXd& run : curves.raw_shifts) shift.push_back(shift_at(run, places));
  return shift;
}

Whitened whitened(const EffectCurves& curves, const Shift& shift) {
  Whitened result(shift.size());
  for (std::size_t r = 0; r < shift.size(); ++r) result[r] = curves.whiteners[r](shift[r]);
  return result;
}

Whitened whitened_difference(const EffectCurves& curves, const std::vector<VectorXd>& a, const Shift& b) {
  Whitened result(a.size());
  for (std::size_t r = 0; r < a.size(); ++r) result[r] = curves.whiteners[r](a[r] - b[r]);
  return result;
}

void measure(Model& model, const EffectCurves& curves, const Coherence& coherence) {
  const Whitened left = whitened_difference(curves, curves.residual, model.shift);
  model.left = squared_length(left);
  model.coherent = coherence.energy(left);
}

Products products_of(const EffectCurves& curves, const Whitened& gap) {
  const auto columns = curves.shifts.front().cols();
  Products sum{0, VectorXd::Zero(columns), Eigen::MatrixXd::Zero(columns, columns)};
  for (std::size_t r = 0; r < gap.size(); ++r) {
    sum.gap_gap += gap[r].squaredNorm();
    sum.shift_gap.noalias() += curves.shifts[r].transpose() * gap[r];
    sum.shift_shift.noalias() += curves.shifts[r].transpose() * curves.shifts[r];
  }
  return sum;
}

std::vector<Model> search_singles(EffectCurves& curves, const Coherence& coherence, const Simulator& simulator,
                                  const SearchSettings& settings) {
  Singles singles = fit_singles(curves);
  for (int round = 0; round < settings.rounds; ++round) {
    if (!refine(curves, singles, settings.contenders, Fidelity::coarse, simulator)) break;
    singles = fit_singles(curves);
  }
  const double nothing_explained = squared_length(curves.gap);
  for (int round = 0; round < settings.exact_rounds; ++round) {
    const std::size_t finalists = near_best(singles.fits, nothing_explained, settings);
    if (!refine(curves, singles, finalists, Fidelity::every_run, simulator)) break;
    singles = fit_singles(curves);
  }
  std::vector<Model> models;
  for (const CurveFit& fit : singles.fits) {
    const OnCurve& place = fit.places.front();
    models.push_back({fit.places, shift_of(curves, fit.places),
                      at_point(curves.curves[place.curve], place, singles.products, Fidelity::every_run)});
    measure(models.back(), curves, coherence);
  }
  return models;
}

std::vector<EffectSet> all_pairs(const EffectCurves& curves) {
  std::vector<EffectSet> pairs;
  for (std::size_t a = 0; a < curves.curves.size(); ++a)
    for (std::size_t b = a + 1; b < curves.curves.size(); ++b)
      // two parameters of one effect are no pair of effects
      if (is_visible(curves.curves[a]) && is_visible(curves.curves[b]) &&
          curves.curves[a].effect != curves.curves[b].effect)
        pairs.push_back({a, b});
  return pairs;
}

std::vector<EffectSet> with_one_more(const EffectCurves& curves, const Model& model) {
  const EffectSet set = effects_of(model);
  std::vector<EffectSet> sets;
  for (std::size_t c = 0; c < curves.curves.size(); ++c) {
    const bool is_in = std::ranges::any_of(
        set, [&](std::size_t member) { return curves.curves[member].effect == curves.curves[c].effect; });
    if (is_in || !is_visible(curves.curves[c])) continue;
    sets.push_back(set);
    sets.back().push_back(c);
  }
  return sets;
}

std::vector<Model> search_sets(const EffectCurves& curves, const Coherence& coherence, const Simulator& simulator,
                               const SearchSettings& settings, std::vector<EffectSet> all, double to_beat) {
  Sets sets(curves, std::move(all), kSetsForAContender * settings.contenders, to_beat);
  for (int round = 0; round < settings.together_rounds; ++round) sets.simulate(Fidelity::coarse, simulator);
  sets.keep_best(settings.contenders);
  sets.keep_best(sets.near_best(squared_length(curves.gap), settings));
  for (int round = 0; round < settings.together_rounds; ++round) sets.simulate(Fidelity::every_run, simulator);
  std::vector<Model> models = sets.models();
  for (Model& model : models) measure(model, curves, coherence);
  std::ranges::stable_sort(models, {}, &Model::left);
  return models;
}

std::vector<Products> products_of_runs_around(const EffectCurves& curves, const Model& model) {
  return products_of_runs(curves, gap_around(curves, model));
}

Products products_around(const EffectCurves& curves, const Model& model) {
  return products_of(curves, gap_around(curves, model));
}

double left_without(const EffectCurves& curves, const Model& model, std::size_t place) {
  EffectSet others = effects_of(model);
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(place));
  const Products products = products_around(curves, model);
  return others.empty() ? products.gap_gap : fit_together(products, curves.curves, others).left;
}

}  // namespace kenaf::gap
