#include "gap/diagnose/decision.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace kenaf::gap {
namespace {

using Eigen::VectorXd;
using Gap = std::vector<VectorXd>;

Products total(const EffectCurves& curves, const Gap& gap) {
  const auto columns = curves.shifts.front().cols();
  Products sum{0, VectorXd::Zero(columns), {}, 0};
  for (std::size_t r = 0; r < gap.size(); ++r) {
    sum.gap_gap += gap[r].squaredNorm();
    sum.shift_gap += curves.shifts[r].transpose() * gap[r];
    sum.bins += static_cast<double>(gap[r].size());
  }
  return sum;
}

Eigen::MatrixXd shift_products(const EffectCurves& curves) {
  const auto columns = curves.shifts.front().cols();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(columns, columns);
  for (const Eigen::MatrixXd& shift : curves.shifts) sum.noalias() += shift.transpose() * shift;
  return sum;
}

Gap minus(const Gap& a, const Gap& b) {
  Gap difference(a.size());
  for (std::size_t r = 0; r < a.size(); ++r) difference[r] = a[r] - b[r];
  return difference;
}

Gap shift_of(const EffectCurves& curves, std::span<const OnCurve> places) {
  Gap shift;
  for (std::size_t r = 0; r < curves.gap.size(); ++r) shift.push_back(shift_at(curves, r, places));
  return shift;
}

// What chance does: the largest improvement by any single effect, and the energy of cells.
struct Chance {
  std::vector<double> improvement, energy;  // sorted
};

Chance draw_chance(const EffectCurves& curves, const Coherence& coherence, std::size_t draws, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Chance chance;
  Products products{0, {}, shift_products(curves), 0};
  Gap noise = curves.gap;
  for (std::size_t i = 0; i < draws; ++i) {
    for (VectorXd& run : noise)
      for (double& value : run) value = normal(random);
    const Products drawn = total(curves, noise);
    products.gap_gap = drawn.gap_gap;
    products.shift_gap = drawn.shift_gap;
    double best = 0;
    for (std::size_t c = 0; c < curves.curves.size(); ++c)
      best = std::max(best, drawn.gap_gap - fit_one(products, curves.curves, c).left);
    chance.improvement.push_back(best);
    chance.energy.push_back(coherence.energy(noise));
  }
  std::ranges::sort(chance.improvement);
  std::ranges::sort(chance.energy);
  return chance;
}

// The share of draws that reach `value`; with one more, so that it is never 0.
double p_value(const std::vector<double>& sorted, double value) {
  const auto reached = sorted.end() - std::ranges::lower_bound(sorted, value);
  return static_cast<double>(reached + 1) / static_cast<double>(sorted.size() + 1);
}

// Beyond the draws, from their mean and spread: draws of a sum of many squares are near to Gaussian.
double p_of_energy(const std::vector<double>& sorted, double value) {
  const double p = p_value(sorted, value);
  if (p > 2.0 / static_cast<double>(sorted.size())) return p;
  double mean = 0, square = 0;
  for (const double energy : sorted) mean += energy, square += energy * energy;
  mean /= static_cast<double>(sorted.size());
  const double sigma = std::sqrt(std::max(1e-12, square / static_cast<double>(sorted.size()) - mean * mean));
  return std::min(p, 0.5 * std::erfc((value - mean) / sigma / std::sqrt(2.0)));
}

struct Search {
  EffectCurves& curves;
  const Coherence& coherence;
  const Simulator& simulator;
  const DecisionSettings& settings;

  Model model(const CurveFit& fit) const {
    Model model{fit.places, fit.left, 0, shift_of(curves, fit.places)};
    model.coherent = coherence.energy(minus(curves.gap, model.shift));
    return model;
  }

  std::vector<CurveFit> fit_singles() const {
    Products products = total(curves, curves.gap);
    products.shift_shift = shift_products(curves);
    std::vector<CurveFit> fits;
    for (std::size_t c = 0; c < curves.curves.size(); ++c) fits.push_back(fit_one(products, curves.curves, c));
    std::ranges::stable_sort(fits, {}, &CurveFit::left);
    return fits;
  }

  // Curves are straight between their points: put a point where each of the best fits.
  std::vector<Model> singles() {
    std::vector<CurveFit> fits = fit_singles();
    for (int round = 0; round < settings.rounds; ++round) {
      std::vector<NewPoint> points;
      for (std::size_t i = 0; i < std::min(settings.rivals_refined, fits.size()); ++i) {
        const OnCurve& place = fits[i].places.front();
        const EffectCurve& curve = curves.curves[place.curve];
        const double width = curve.parameter->max - curve.parameter->min;
        const bool known = std::ranges::any_of(curve.points, [&](const CurvePoint& point) {
          return std::abs(point.value - place.value) < 1e-4 * width;
        });
        if (!known) points.push_back({place.curve, place.value});
      }
      if (points.empty()) break;
      simulator.add_points(curves, points);
      fits = fit_singles();
    }
    std::vector<Model> models;
    for (const CurveFit& fit : fits) models.push_back(model(fit));
    return models;
  }

  // Pairs by the sum of their curves; the best ones simulated, and fitted again with what the sum lacks.
  std::vector<Model> pairs(const std::vector<Model>& singles) {
    Products products = total(curves, curves.gap);
    products.shift_shift = shift_products(curves);
    std::vector<CurveFit> fits;
    for (std::size_t a = 0; a < curves.curves.size(); ++a)
      for (std::size_t b = a + 1; b < curves.curves.size(); ++b)
        if (curves.curves[a].visible > 1 && curves.curves[b].visible > 1)
          fits.push_back(fit_two(products, curves.curves, a, b));
    std::ranges::stable_sort(fits, {}, &CurveFit::left);
    (void)singles;
    fits.resize(std::min(fits.size(), 2 * settings.rivals_refined));
    std::vector<Model> models(fits.size());
    for (int round = 0; round < settings.rounds; ++round) {
      std::vector<std::vector<OnCurve>> asked;
      for (const CurveFit& fit : fits) asked.push_back(fit.places);
      const auto exact = simulator.exact(asked);
      for (std::size_t i = 0; i < fits.size(); ++i) {
        const Gap lacking = minus(exact[i], shift_of(curves, fits[i].places));
        Model& model = models[i];
        const double left = minus(curves.gap, exact[i])
                                .empty() ? 0 : [&] {
                                  double sum = 0;
                                  for (const VectorXd& run : minus(curves.gap, exact[i])) sum += run.squaredNorm();
                                  return sum;
                                }();
        if (round == 0 || left < model.left) {
          model = {fits[i].places, left, 0, exact[i]};
          model.coherent = coherence.energy(minus(curves.gap, exact[i]));
        }
        if (round + 1 == settings.rounds) continue;
        const Products corrected = total(curves, minus(curves.gap, lacking));
        products.gap_gap = corrected.gap_gap;
        products.shift_gap = corrected.shift_gap;
        fits[i] = fit_two(products, curves.curves, fits[i].places[0].curve, fits[i].places[1].curve);
      }
    }
    std::ranges::stable_sort(models, {}, &Model::left);
    return models;
  }
};

bool has_curve(const Model& model, std::size_t curve) {
  return std::ranges::any_of(model.places, [&](const OnCurve& place) { return place.curve == curve; });
}

}  // namespace

double inflation_from_repeats(const std::vector<FeatureMap>& features, const NoiseFloor& floor,
                              const std::vector<VectorXd>& deviations, double stretch_s) {
  std::vector<double> squares;
  for (std::size_t r = 0; r < features.size(); ++r) {
    if (deviations[r].size() == 0) continue;
    const Coherence one({features[r]}, {{0}}, stretch_s);
    for (const Cell& cell : one.cells({floor.whiteners[r](deviations[r])})) squares.push_back(cell.z * cell.z);
  }
  if (squares.empty()) return 1;
  std::ranges::sort(squares);
  squares.resize(std::max<std::size_t>(1, squares.size() * 95 / 100));
  double sum = 0;
  for (const double square : squares) sum += square;
  // the mean of the lower 95 % of squares of a standard normal is 0.759
  return std::max(1.0, sum / static_cast<double>(squares.size()) / 0.759);
}

Decision decide(EffectCurves& curves, const Coherence& coherence, double inflation, const Simulator& simulator,
                const DecisionSettings& settings, std::uint64_t seed) {
  Decision decision;
  decision.inflation = inflation;
  const Chance chance = draw_chance(curves, coherence, settings.null_draws, seed);
  decision.chance_coherent = static_cast<double>(coherence.cell_count());
  decision.nominal_coherent = coherence.energy(curves.gap);
  double nominal_left = 0;
  for (const VectorXd& run : curves.gap) nominal_left += run.squaredNorm();

  Search search{curves, coherence, simulator, settings};
  decision.singles = search.singles();
  const Model& single = decision.singles.front();
  const double p_single = p_value(chance.improvement, (nominal_left - single.left) / inflation);
  const double p_energy = p_of_energy(chance.energy, decision.nominal_coherent / inflation);
  decision.p_gap = std::min(1.0, 2 * std::min(p_single, p_energy));
  decision.best = {{}, nominal_left, decision.nominal_coherent, {}};
  decision.p_left = p_energy;
  if (decision.p_gap > settings.false_alarm) return decision;

  const auto allowed = [&](const Model& model) {
    return settings.rival_margin * inflation +
           settings.model_share * settings.model_share * std::max(0.0, nominal_left - model.left);
  };
  const auto p_left = [&](const Model& model) {
    const double modelled = settings.model_share * settings.model_share * std::max(0.0, decision.nominal_coherent);
    return p_of_energy(chance.energy, (model.coherent - modelled) / inflation);
  };

  const std::vector<Model> pairs = search.pairs(decision.singles);
  const Model* chosen = &single;
  decision.p_left = p_left(single);
  if (!pairs.empty()) {
    const Model& pair = pairs.front();
    // a second effect must earn more than the luckiest of all pairs does by chance
    const double luck = chance.improvement[chance.improvement.size() * 99 / 100] * 2;
    const bool needed = single.left - pair.left > std::max(luck * inflation, allowed(single));
    if (needed && (decision.p_left <= settings.surprise || p_left(pair) > settings.surprise)) {
      chosen = &pair;
      decision.p_left = p_left(pair);
    }
  }
  decision.best = *chosen;
  if (decision.p_left <= settings.surprise) {
    decision.verdict = Verdict::unknown;
    for (const OnCurve& place : chosen->places) decision.rivals.push_back({place.curve});
    return decision;
  }

  decision.verdict = Verdict::named;
  for (const OnCurve& place : chosen->places) {
    std::vector<std::size_t> rivals{place.curve};
    const std::vector<Model>& models = chosen->places.size() == 1 ? decision.singles : pairs;
    for (const Model& model : models) {
      if (model.left - chosen->left > allowed(*chosen)) break;
      if (has_curve(model, place.curve)) continue;
      const bool others_stay = std::ranges::all_of(chosen->places, [&](const OnCurve& other) {
        return other.curve == place.curve || has_curve(model, other.curve);
      });
      if (!others_stay) continue;
      for (const OnCurve& rival : model.places)
        if (!has_curve(*chosen, rival.curve)) rivals.push_back(rival.curve);
    }
    if (rivals.size() > 1) decision.verdict = Verdict::ambiguous;
    decision.rivals.push_back(std::move(rivals));
  }
  return decision;
}

}  // namespace kenaf::gap
