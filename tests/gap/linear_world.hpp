// A world in which the diagnosis' statistics have answers by hand: noise of sigma 1 in every bin, and effects whose shifts
// are fixed vectors times their parameter, so that any two add and every curve is straight.
//
// Two manoeuvres of 3 s, twice each, four channels, two of them of the drives: 192 bins of 0.25 s. A direction is constant in a cell (one channel in
// one second of a manoeuvre, in both repeats: 8 bins) and of length 1; directions 0 to 23 are orthonormal.
#pragma once

#include <Eigen/QR>
#include <cmath>
#include <random>
#include <utility>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/decision.hpp"
#include "tests/gap/made_run.hpp"

namespace kenaf::test {

using Whole = Eigen::VectorXd;  // all bins of all runs, one after another

// The channels, in the order of their bins.
enum class WorldChannel { track, battery, x, yaw };

class LinearWorld {
 public:
  static constexpr std::size_t kRuns = 4, kBinsOfRun = 48, kBins = kRuns * kBinsOfRun, kCells = 24;

  LinearWorld() {
    const auto zero = [](double) { return 0.0; };
    const runs::Run run = made_run(3, 0.05, {{"track_left_mps", zero}, {"battery_v", zero}, {"x_m", zero}, {"yaw_rad", zero}});
    for (std::size_t r = 0; r < kRuns; ++r) features.emplace_back(run, 0.25);
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    const Eigen::MatrixXd any = Eigen::MatrixXd::NullaryExpr(kCells, kCells, [&] { return normal(random); });
    cells_ = Eigen::HouseholderQR<Eigen::MatrixXd>(any).householderQ();
  }

  Whole direction(std::size_t number) const {
    Whole whole(kBins);
    for (std::size_t i = 0; i < kBins; ++i) {
      const std::size_t run = i / kBinsOfRun, channel = i % kBinsOfRun / 12, second = i % 12 / 4;
      const std::size_t cell = (run / 2 * 4 + channel) * 3 + second;
      whole[static_cast<Eigen::Index>(i)] =
          cells_(static_cast<Eigen::Index>(cell), static_cast<Eigen::Index>(number)) / std::sqrt(8.0);
    }
    return whole;
  }

  // The same in all bins of a channel, of that length in floors. Second manoeuvre: the same, or the opposite of it.
  static Whole in_channel(WorldChannel channel, double length, double second_manoeuvre = 1) {
    constexpr double kBinsOfChannel = 48;
    Whole whole = Whole::Zero(kBins);
    for (std::size_t i = 0; i < kBins; ++i)
      if (i % kBinsOfRun / 12 == static_cast<std::size_t>(channel))
        whole[static_cast<Eigen::Index>(i)] =
            length / std::sqrt(kBinsOfChannel) * (i < kBins / 2 ? 1 : second_manoeuvre);
    return whole;
  }

  static Whole noise(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    return Whole::NullaryExpr(kBins, [&] { return normal(random); });
  }

  static std::vector<Eigen::VectorXd> by_run(const Whole& whole) {
    std::vector<Eigen::VectorXd> runs;
    for (std::size_t r = 0; r < kRuns; ++r)
      runs.push_back(whole.segment(static_cast<Eigen::Index>(r * kBinsOfRun), kBinsOfRun));
    return runs;
  }

  // Curves of effects that shift by `per_value[i]` for each unit of their parameter beyond neutral. Their catalogue entries
  // only lend names and ranges: each from -1 to 1, neutral at 0.
  // Coarse simulations say `rough` times as much.
  gap::EffectCurves curves(const std::vector<Whole>& per_value, const Whole& gap, double rough = 1) const {
    gap::EffectCurves curves;
    curves.residual = curves.gap = by_run(gap);
    for (std::size_t r = 0; r < kRuns; ++r) curves.raw_shifts.emplace_back(kBinsOfRun, 0);
    curves.shifts = curves.raw_shifts;
    gap::set_whiteners(curves, whiteners());
    std::vector<gap::NewPoint> points;
    for (std::size_t i = 0; i < per_value.size(); ++i) {
      curves.curves.push_back({&physics::effect_catalogue()[i], &kParameter, {{0, -1, true}}, 0});
      for (const double value : {-1.0, -0.25, 0.25, 1.0}) points.push_back({i, value});
    }
    simulator(per_value, rough).add_points(curves, points, gap::Fidelity::coarse);
    return curves;
  }

  gap::Simulator simulator(const std::vector<Whole>& per_value, double rough = 1) const {
    const auto shift_of = [per_value, rough](std::span<const gap::NewPoint> effects, gap::Fidelity fidelity) {
      const double factor = fidelity == gap::Fidelity::coarse ? rough : 1;
      Whole whole = Whole::Zero(kBins);
      for (const gap::NewPoint& effect : effects) whole += factor * effect.value * per_value[effect.curve];
      return by_run(whole);
    };
    return {[shift_of](gap::EffectCurves& curves, std::span<const gap::NewPoint> points, gap::Fidelity fidelity) {
              std::vector<gap::Shift> shifts;
              for (const gap::NewPoint& point : points) shifts.push_back(shift_of({&point, 1}, fidelity));
              gap::insert_points(curves, points, shifts, fidelity);
            },
            [shift_of](std::span<const std::vector<gap::NewPoint>> asked, gap::Fidelity fidelity) {
              std::vector<gap::Shift> shifts;
              for (const std::vector<gap::NewPoint>& effects : asked) shifts.push_back(shift_of(effects, fidelity));
              return shifts;
            },
            [](std::span<const gap::NewPoint>) { return whiteners(); }, [] { return std::vector<Eigen::MatrixXd>{}; },
            [](const gap::Shift&) { return static_cast<double>(kBins); }};
  }

  gap::Coherence coherence() const { return {features, repeats, 1}; }
  static gap::Spread spread() { return {1, static_cast<double>(kBins)}; }
  gap::NoiseFloor floor() const {
    return {std::vector<double>(gap::diagnosis_channels().size(), 1),
            std::vector<Eigen::VectorXd>(kRuns, Eigen::VectorXd::Ones(kBinsOfRun)), whiteners(), true};
  }

  gap::Decision decide(const std::vector<Whole>& per_value, const Whole& gap,
                       const gap::DecisionSettings& settings, double rough = 1) const {
    gap::EffectCurves known = curves(per_value, gap, rough);
    return gap::decide(known, coherence(), spread(), simulator(per_value, rough), settings, 1);
  }

  // The best fit of these effects, as a model that was simulated.
  gap::Model fitted(const gap::EffectCurves& curves, std::initializer_list<std::size_t> effects) const {
    const gap::Products products = gap::products_of(curves, curves.gap);
    const std::size_t first = *effects.begin();
    const gap::CurveFit fit = effects.size() == 1 ? gap::fit_one(products, curves.curves, first)
                                                  : gap::fit_two(products, curves.curves, first, *(effects.begin() + 1));
    gap::Model model{fit.places, {}, true};
    for (const Eigen::MatrixXd& shifts : curves.raw_shifts) model.shift.push_back(gap::shift_at(shifts, fit.places));
    gap::measure(model, curves, coherence());
    return model;
  }

  std::vector<gap::FeatureMap> features;
  static inline const std::vector<std::vector<std::size_t>> repeats{{0, 1}, {2, 3}};

 private:
  static constexpr physics::EffectParameter kParameter{"amount", "1", 0, -1, 1, &physics::Effects::command_gain};
  static std::vector<gap::Whitener> whiteners() {
    const Eigen::VectorXd sigma = Eigen::VectorXd::Ones(kBinsOfRun);
    return std::vector<gap::Whitener>(kRuns, gap::Whitener(sigma, Eigen::MatrixXd::Zero(kBinsOfRun, 1)));
  }
  Eigen::MatrixXd cells_;
};

inline const LinearWorld& world() {
  static const LinearWorld world;  // every test case is a process: only those that use it pay
  return world;
}

// Draws enough for probabilities down to 0.0025, and no more.
inline gap::DecisionSettings quick() {
  gap::DecisionSettings settings;
  settings.null_draws = 500;
  return settings;
}

}  // namespace kenaf::test
