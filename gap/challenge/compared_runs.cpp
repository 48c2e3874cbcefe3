#include "gap/challenge/compared_runs.hpp"

#include <algorithm>
#include <cmath>

#include "gap/diagnose/diagnosis.hpp"
#include "gap/diagnose/repeats.hpp"

namespace kenaf::gap::challenge {
namespace {

constexpr std::size_t kMostRuns = 100;  // all runs of a case

}  // namespace

ComparedRuns::ComparedRuns(const std::filesystem::path& dataset, unsigned threads, const std::atomic<bool>* stop)
    : observations(diagnose::observe(dataset, "", "", kMostRuns)),
      features(diagnose::compared_features(observations, diagnose::DiagnosisOptions().span_s)),
      predictor(observations, features, diagnose::repeats_of(observations), threads, stop),
      same_command_sequence(diagnose::same_command_sequence_of(observations)) {
  predictor.simulate_nominal();
  for (std::size_t s = 0; s < kEachChannelOnce.size(); ++s) {
    const std::vector<diagnose::StageFeatures>& stage = features.of(kEachChannelOnce[s]);
    for (std::size_t r = 0; r < stage.size(); ++r)
      residuals[s].push_back(stage[r].measured - predictor.nominal(kEachChannelOnce[s])[r]);
  }
}

Differences operator-(Differences a, const Differences& b) {
  for (std::size_t s = 0; s < a.size(); ++s)
    for (std::size_t r = 0; r < a[s].size(); ++r) a[s][r] -= b[s][r];
  return a;
}

Floors floors_around(ComparedRuns& runs, const diagnose::Variation& model) {
  Floors floors;
  for (std::size_t s = 0; s < floors.size(); ++s) {
    const diagnose::Passage passage = kEachChannelOnce[s];
    const std::vector<diagnose::StageFeatures>& features = runs.features.of(passage);
    floors[s] = diagnose::noise_floor(features, runs.residuals[s], runs.same_command_sequence,
                                      diagnose::open_shapes(features, runs.predictor, passage, model,
                                                            diagnose::kOpenStart_m, diagnose::kOpenStart_rad));
  }
  return floors;
}

Differences shifts_of(ComparedRuns& runs, const physics::RobotDescription& robot, diagnose::Fidelity fidelity) {
  diagnose::Variation variation = runs.predictor.unvaried();
  variation.robot = robot;
  Differences shifts;
  for (std::size_t s = 0; s < shifts.size(); ++s)
    shifts[s] = runs.predictor.shifts({&variation, 1}, kEachChannelOnce[s], fidelity).front();
  return shifts;
}

double rms(const Floors& floors, const Differences& differences) {
  double sum = 0, bins = 0;
  for (std::size_t s = 0; s < floors.size(); ++s)
    for (std::size_t r = 0; r < differences[s].size(); ++r) {
      if (differences[s][r].size() == 0) continue;
      sum += floors[s].whiteners[r](differences[s][r]).squaredNorm();
      bins += static_cast<double>(differences[s][r].size());
    }
  return bins > 0 ? std::sqrt(sum / bins) : 0;
}

double rms_of_repeats(const ComparedRuns& runs, const Floors& floors, const Differences& residuals) {
  double sum = 0, bins = 0;
  for (std::size_t s = 0; s < floors.size(); ++s) {
    const std::vector<diagnose::StageFeatures>& features = runs.features.of(kEachChannelOnce[s]);
    const auto [deviations, shared] =
        diagnose::deviations_from_repeats(features, residuals[s], runs.same_command_sequence);
    for (std::size_t r = 0; r < deviations.size(); ++r) {
      if (deviations[r].size() == 0) continue;
      sum += floors[s].whiteners[r](deviations[r]).squaredNorm();
      bins += static_cast<double>(std::ranges::count(shared[r], true));
    }
  }
  return bins > 0 ? std::sqrt(sum / bins) : 1;
}

}  // namespace kenaf::gap::challenge
