#include "gap/challenge/shrinks.hpp"

#include <algorithm>

#include "gap/diagnose/gap_size.hpp"
#include "gap/diagnose/repeats.hpp"

namespace kenaf::gap::challenge {
namespace {

struct Squares {
  diagnose::KindSquares before, report, hidden, repeats;
};

void append(diagnose::KindSquares& to, const diagnose::KindSquares& more) {
  to.sum.insert(to.sum.end(), more.sum.begin(), more.sum.end());
  to.bins.insert(to.bins.end(), more.bins.begin(), more.bins.end());
}

Shrinks shrinks_of(const Squares& squares) {
  const std::vector<double> weights = diagnose::kind_weights(squares.before, squares.repeats);
  Shrinks result;
  result.before = diagnose::weighted_rms(squares.before, weights);
  // Without repeats only the noise is known to remain.
  const double of_repeats = diagnose::weighted_rms(squares.repeats, weights);
  result.floor = std::min(of_repeats > 0 ? of_repeats : 1.0, result.before);
  result.report = diagnose::shrink(result.before, diagnose::weighted_rms(squares.report, weights), result.floor);
  result.hidden = diagnose::shrink(result.before, diagnose::weighted_rms(squares.hidden, weights), result.floor);
  return result;
}

}  // namespace

ShrinksOfRuns shrinks_on(const std::filesystem::path& dataset, const physics::RobotDescription& report,
                         const physics::RobotDescription& hidden, unsigned threads) {
  ComparedRuns runs(dataset, threads);
  // The noise floor around the true model, and what each robot leaves of the gap.
  diagnose::Variation model = runs.predictor.unvaried();
  model.robot = hidden;
  const Floors floors = floors_around(runs, model);
  const Differences by_report = runs.residuals - shifts_of(runs, report, diagnose::Fidelity::every_run);
  const Differences by_hidden = runs.residuals - shifts_of(runs, hidden, diagnose::Fidelity::every_run);

  // Each stage by itself; then all stages together, which keep their own kinds of channels.
  ShrinksOfRuns result;
  Squares together;
  for (std::size_t s = 0; s < kEachChannelOnce.size(); ++s) {
    const std::vector<diagnose::StageFeatures>& features = runs.features.of(kEachChannelOnce[s]);
    const auto squares = [&](const diagnose::Shift& differences) {
      return diagnose::squares_by_kind(features, floors[s], differences);
    };
    const Squares stage{squares(runs.residuals[s]), squares(by_report[s]), squares(by_hidden[s]),
                        diagnose::squares_of_floor(
                            features, floors[s],
                            diagnose::deviations_from_repeats(features, by_hidden[s], runs.same_command_sequence))};
    result.of_stage[s] = shrinks_of(stage);
    append(together.before, stage.before);
    append(together.report, stage.report);
    append(together.hidden, stage.hidden);
    append(together.repeats, stage.repeats);
  }
  result.together = shrinks_of(together);
  return result;
}

}  // namespace kenaf::gap::challenge
