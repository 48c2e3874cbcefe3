#include "gap/challenge/look_alike.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "gap/challenge/stand_ins.hpp"
#include "gap/diagnose/curve_fit.hpp"
#include "gap/diagnose/decision_settings.hpp"
#include "gap/diagnose/model_search.hpp"
#include "gap/diagnose/stage_candidates.hpp"

namespace kenaf::gap::challenge {
namespace {

// The candidates nearest by a first look get whole curves; the nearest of these get points where they fit best, in
// kRounds rounds (chosen: the nearest one hardly moves after that).
constexpr std::size_t kFollowed = 12, kRefined = 4;
constexpr int kRounds = 2;

struct Near {
  double left;  // of the squared length of the hidden shift
  std::size_t candidate;
  double value;
};

class Stage {
 public:
  Stage(ComparedRuns& runs, diagnose::Passage passage, diagnose::StageData data,
        std::span<const candidates::Candidate> candidates)
      : data_(std::move(data)),
        whiteners_(diagnose::whiteners_of(data_, diagnose::no_discrepancy())),
        curves_(diagnose::empty_curves(data_, candidates)) {
    simulate_ = [&runs, passage, candidates, this](std::span<const diagnose::Settings> asked, diagnose::Fidelity) {
      std::vector<diagnose::Variation> variations;
      for (const diagnose::Settings& settings : asked) {
        variations.push_back(runs.predictor.unvaried());
        variations.back().robot = diagnose::with_settings(std::move(variations.back().robot), candidates, settings);
      }
      std::vector<diagnose::GroupVectors> shifts;
      for (const diagnose::Shift& shift : runs.predictor.shifts(variations, passage, diagnose::Fidelity::coarse))
        shifts.push_back(diagnose::mean_of_groups(data_, shift));
      return shifts;
    };
    const bool drives_measured = std::ranges::all_of(
        runs.observations.runs, [](const diagnose::Observation& run) { return run.measured.has_value(); });
    possible_ = diagnose::candidates_of(passage, candidates, drives_measured);
  }

  // Returns the candidates, the nearest first: first look, whole curves of the best ones, then refinement.
  std::vector<Near> nearest() {
    diagnose::add_first_look(curves_, data_, possible_, simulate_);
    std::vector<std::size_t> followed;
    for (const Near& near : ranked())
      if (followed.size() < kFollowed) followed.push_back(near.candidate);
    diagnose::add_spread(curves_, data_, followed, simulate_);
    diagnose::follow_bends(curves_, data_, followed, simulate_);
    std::vector<Near> best = ranked();
    for (int round = 0; round < kRounds; ++round) {
      std::vector<diagnose::Setting> points;
      for (std::size_t i = 0; i < std::min(kRefined, best.size()); ++i)
        points.push_back({best[i].candidate, best[i].value});
      diagnose::add_points(curves_, data_, points, diagnose::Fidelity::coarse, simulate_);
      best = ranked();
    }
    return best;
  }

  double hidden_squared() const {
    return diagnose::products_of(whiteners_, curves_.shifts, diagnose::residuals_of(data_)).gap_gap;
  }

 private:
  std::vector<Near> ranked() const {
    const diagnose::Products products =
        diagnose::products_of(whiteners_, curves_.shifts, diagnose::residuals_of(data_));
    std::vector<Near> result;
    for (const std::size_t c : possible_) {
      const diagnose::CurveFit fit = diagnose::fit_one(products, curves_.curves, c);
      result.push_back({fit.left, c, fit.places.front().value});
    }
    std::ranges::stable_sort(result, {}, &Near::left);
    return result;
  }

  diagnose::StageData data_;
  std::vector<diagnose::GroupWhitener> whiteners_;
  diagnose::EffectCurves curves_;
  diagnose::Simulate simulate_;
  std::vector<std::size_t> possible_;
};

// Whether the shift cannot be overlooked in a stage.
bool shows(const diagnose::StageData& data) {
  const auto bins = static_cast<double>(diagnose::bin_count(data));
  return bins > 0 && diagnose::gap_in_noise(data) >= diagnose::DecisionSettings().negligible * std::sqrt(bins);
}

}  // namespace

LookAlike look_alike(ComparedRuns& runs, const Floors& floors, const Differences& hidden,
                     std::span<const std::string> without) {
  const std::vector<candidates::Candidate> candidates = candidates::leave_out(
      candidates::all_candidates(runs.observations.robot, diagnose::has_obstacles(runs.observations)), without);
  LookAlike nearest;
  for (std::size_t s = 0; s < kEachChannelOnce.size(); ++s) {
    const diagnose::Passage passage = kEachChannelOnce[s];
    diagnose::StageData data =
        diagnose::stage_data(passage, runs.features.of(passage), runs.predictor.repeats(), hidden[s], floors[s]);
    if (!shows(data)) continue;
    Stage stage(runs, passage, std::move(data), candidates);
    const std::vector<Near> ranking = stage.nearest();
    const double all = stage.hidden_squared();
    if (ranking.empty() || !(all > 0)) continue;

    // The candidate leaves left / all = sin^2(angle) of the squared length.
    const double angle_deg =
        std::asin(std::sqrt(std::clamp(ranking.front().left / all, 0.0, 1.0))) * 180 / std::numbers::pi;
    if (nearest.effect.empty() || angle_deg < nearest.angle_deg)
      nearest = {candidates[ranking.front().candidate].name, angle_deg};
  }
  return nearest;
}

}  // namespace kenaf::gap::challenge
