// A world in which the diagnosis' statistics have answers by hand: noise of sigma 1 in every bin of a run, and effects
// whose shifts are fixed vectors times their parameter, so that any two add and every curve is straight.
//
// Manoeuvres, each repeated, in four channels of different kinds, two of them of the drives; bins of 0.25 s. A
// direction is constant in a cell (one channel in one second of a manoeuvre, in all repeats) and of length 1 in noise;
// directions are orthonormal. A length in noise is the same over all runs as over the means of repeats: of n repeats
// the mean has 1 / n of the variance.
#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/judgement.hpp"
#include "gap/diagnose/stage_diagnosis.hpp"

namespace kenaf::test {

using Whole = Eigen::VectorXd;  // all bins of all runs, one after another

// The channels, in the order of their bins.
enum class WorldChannel { track, battery, x, yaw };

struct WorldSize {
  std::size_t manoeuvres = 2, repeats = 2, seconds = 3;
};

class LinearWorld {
 public:
  using Size = WorldSize;
  // What settings together shift.
  using Moved = std::function<Whole(const gap::diagnose::Settings&)>;
  static constexpr std::size_t kChannels = 4, kBinsOfSecond = 4, kCandidates = 16;

  explicit LinearWorld(Size of = {}) : size(of) {
    for (std::size_t r = 0; r < runs(); ++r) {
      features.push_back({{}, 0.25, Eigen::VectorXd::Zero(bins_of_run()), {}});
      for (const char* column : {"track_left_mps", "battery_v", "x_m", "yaw_rad"})
        for (std::size_t span = 0; span < size.seconds * kBinsOfSecond; ++span)
          features.back().bins.push_back({channel_of(column), span, 5});
    }
    for (std::size_t m = 0; m < size.manoeuvres; ++m) {
      repeats.emplace_back();
      for (std::size_t r = 0; r < size.repeats; ++r) repeats.back().push_back(m * size.repeats + r);
    }
    for (std::size_t c = 0; c < kCandidates; ++c) {
      candidates_.push_back({});
      candidates_.back().name = "effect " + std::to_string(c);
      candidates_.back().min = -1;
      candidates_.back().max = 1;
    }
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    const auto cells = static_cast<Eigen::Index>(size.manoeuvres * kChannels * size.seconds);
    const Eigen::MatrixXd any =
        Eigen::MatrixXd::NullaryExpr(cells, std::min<Eigen::Index>(cells, 24), [&] { return normal(random); });
    cells_ =
        Eigen::HouseholderQR<Eigen::MatrixXd>(any).householderQ() * Eigen::MatrixXd::Identity(any.rows(), any.cols());
    groups_ = data(Whole::Zero(bins()));
  }

  std::size_t runs() const { return size.manoeuvres * size.repeats; }
  Eigen::Index bins_of_channel() const { return static_cast<Eigen::Index>(size.seconds * kBinsOfSecond); }
  Eigen::Index bins_of_run() const { return static_cast<Eigen::Index>(kChannels) * bins_of_channel(); }
  Eigen::Index bins() const { return static_cast<Eigen::Index>(runs()) * bins_of_run(); }
  Eigen::Index bins_of_manoeuvre() const { return static_cast<Eigen::Index>(size.repeats) * bins_of_run(); }

  Whole direction(Eigen::Index number) const {
    Whole whole(bins());
    for (Eigen::Index i = 0; i < bins(); ++i) {
      const Eigen::Index manoeuvre = i / bins_of_manoeuvre(), channel = i % bins_of_run() / bins_of_channel();
      const Eigen::Index second = i % bins_of_channel() / static_cast<Eigen::Index>(kBinsOfSecond);
      const auto seconds = static_cast<Eigen::Index>(size.seconds);
      whole[i] = cells_((manoeuvre * static_cast<Eigen::Index>(kChannels) + channel) * seconds + second, number) /
                 std::sqrt(static_cast<double>(kBinsOfSecond * size.repeats));
    }
    return whole;
  }

  // The same in all bins of a channel, of that length in noise.
  Whole in_channel(WorldChannel channel, double length) const {
    Whole whole = Whole::Zero(bins());
    for (Eigen::Index i = 0; i < bins(); ++i)
      if (i % bins_of_run() / bins_of_channel() == static_cast<Eigen::Index>(channel))
        whole[i] = length / std::sqrt(static_cast<double>(runs() * size.seconds * kBinsOfSecond));
    return whole;
  }

  Whole noise(std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    return Whole::NullaryExpr(bins(), [&] { return normal(random); });
  }

  // A discrepancy: of each manoeuvre and channel a stationary Ornstein-Uhlenbeck process, the same in all repeats.
  Whole wander(double sigma, double memory_s, std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const double decay = std::exp(-0.25 / memory_s);
    Whole whole(bins());
    for (std::size_t m = 0; m < size.manoeuvres; ++m) {
      Eigen::VectorXd one(bins_of_run());
      for (Eigen::Index i = 0; i < one.size(); ++i)
        one[i] = i % bins_of_channel() == 0
                     ? sigma * normal(random)
                     : decay * one[i - 1] + sigma * std::sqrt(1 - decay * decay) * normal(random);
      for (const std::size_t r : repeats[m])
        whole.segment(static_cast<Eigen::Index>(r) * bins_of_run(), bins_of_run()) = one;
    }
    return whole;
  }

  std::vector<Eigen::VectorXd> by_run(const Whole& whole) const {
    std::vector<Eigen::VectorXd> result;
    for (std::size_t r = 0; r < runs(); ++r)
      result.push_back(whole.segment(static_cast<Eigen::Index>(r) * bins_of_run(), bins_of_run()));
    return result;
  }
  gap::diagnose::GroupVectors by_group(const Whole& whole) const {
    return gap::diagnose::mean_of_groups(groups_, by_run(whole));
  }

  gap::diagnose::NoiseFloor floor() const {
    const Eigen::VectorXd sigma = Eigen::VectorXd::Ones(bins_of_run());
    const Eigen::MatrixXd none(bins_of_run(), 0);
    return {std::vector<double>(gap::diagnose::diagnosis_channels().size(), 1),
            std::vector<Eigen::VectorXd>(runs(), sigma),
            std::vector<gap::diagnose::Whitener>(runs(), gap::diagnose::Whitener(sigma, none)),
            true,
            std::vector<gap::diagnose::OpenShapes>(runs(), {none, none, Eigen::VectorXd::Zero(bins_of_run())}),
            std::vector<Eigen::VectorXd>(runs(), sigma)};
  }
  gap::diagnose::StageData data(const Whole& gap, const gap::diagnose::UsedParts& used = {}) const {
    return gap::diagnose::stage_data(gap::diagnose::Passage::drive_to_body, features, repeats, by_run(gap), floor(),
                                     used);
  }

  gap::diagnose::Folds folds_by_manoeuvre() const {
    gap::diagnose::Folds folds;
    for (const auto& group : repeats) folds.emplace_back(group.begin(), group.end());
    return folds;
  }

  static std::size_t channel_of(std::string_view column) {
    std::size_t channel = 0;
    while (gap::diagnose::diagnosis_channels()[channel].column != column) ++channel;
    return channel;
  }

  // The first ones of kCandidates, each from -1 to 1, neutral at 0.
  std::span<const gap::candidates::Candidate> candidates(std::size_t count) const {
    return {candidates_.data(), count};
  }

  // Effects that shift by `per_value[i]` for each unit of their parameter.
  static Moved linear(const std::vector<Whole>& per_value) {
    return [per_value](const gap::diagnose::Settings& settings) {
      Whole whole = Whole::Zero(per_value.front().size());
      for (const gap::diagnose::Setting& setting : settings) whole += setting.value * per_value[setting.candidate];
      return whole;
    };
  }
  // Coarse simulations say `rough` times as much.
  gap::diagnose::Simulate simulate(const Moved& moved, double rough = 1) const {
    return [this, moved, rough](std::span<const gap::diagnose::Settings> asked, gap::diagnose::Fidelity fidelity) {
      std::vector<gap::diagnose::GroupVectors> shifts;
      for (const gap::diagnose::Settings& settings : asked)
        shifts.push_back(by_group((fidelity == gap::diagnose::Fidelity::coarse ? rough : 1) * moved(settings)));
      return shifts;
    };
  }

  // Of `count` effects, at a quarter and the whole of the way to either end.
  gap::diagnose::EffectCurves curves(const Moved& moved, std::size_t count, const gap::diagnose::StageData& of,
                                     double rough = 1) const {
    gap::diagnose::EffectCurves curves = gap::diagnose::empty_curves(of, candidates(count));
    std::vector<std::size_t> all;
    for (std::size_t c = 0; c < count; ++c) all.push_back(c);
    gap::diagnose::add_spread(curves, of, all, simulate(moved, rough));
    return curves;
  }
  gap::diagnose::EffectCurves curves(const std::vector<Whole>& per_value, const gap::diagnose::StageData& of,
                                     double rough = 1) const {
    return curves(linear(per_value), per_value.size(), of, rough);
  }

  // The best fit of these effects on straight curves.
  gap::diagnose::StandingModel fitted(const std::vector<Whole>& per_value, const gap::diagnose::StageData& of,
                                      const std::vector<std::size_t>& effects) const {
    gap::diagnose::EffectCurves known = curves(per_value, of);
    gap::diagnose::Model model = gap::diagnose::fit_model(of, known, effects, {}, gap::diagnose::no_discrepancy());
    return {std::move(model), std::move(known)};
  }

  // The simulation leaves the same open around any model: nothing.
  gap::diagnose::StageDecision decide(const Moved& moved, std::size_t count, const Whole& gap, double rough = 1,
                                      const gap::diagnose::GapTest& test = {},
                                      const gap::diagnose::DecisionSettings& settings = {}) const {
    const gap::diagnose::StageAround nominal{floor(), data(gap)};
    gap::diagnose::StageDecision decision = gap::diagnose::decide_stage(
        nominal, curves(moved, count, nominal.data, rough), simulate(moved, rough),
        [&](const gap::diagnose::Settings&, std::span<const std::size_t>) { return nominal; }, test, settings);
    if (decision.effects.empty()) return decision;
    const std::vector<Eigen::VectorXd> residuals = by_run(gap);
    const gap::diagnose::StageView view{&features, &repeats, &residuals, &decision.floor};
    const auto shares = [&](const gap::diagnose::Folds& folds) {
      return gap::diagnose::shares_held_out(view, gap::diagnose::Passage::drive_to_body, decision.best, {}, folds, 1);
    };
    gap::diagnose::judge(decision, candidates(count), shares(gap::diagnose::folds_by_repeat(repeats)),
                         shares(folds_by_manoeuvre()), settings);
    return decision;
  }
  gap::diagnose::StageDecision decide(const std::vector<Whole>& per_value, const Whole& gap, double rough = 1) const {
    return decide(linear(per_value), per_value.size(), gap, rough);
  }

  const Size size;
  std::vector<gap::diagnose::StageFeatures> features;
  std::vector<std::vector<std::size_t>> repeats;

 private:
  std::vector<gap::candidates::Candidate> candidates_;
  Eigen::MatrixXd cells_;
  gap::diagnose::StageData groups_{gap::diagnose::Passage::drive_to_body, {}};  // without a gap
};

inline const LinearWorld& world() {
  static const LinearWorld world;  // every test case is a process: only those that use it pay
  return world;
}

// Shifts of one kind of channels in the whole world, of a length in noise.
inline Whole position(double length) {
  return world().in_channel(WorldChannel::x, length);
}
inline Whole yaw(double length) {
  return world().in_channel(WorldChannel::yaw, length);
}

}  // namespace kenaf::test
