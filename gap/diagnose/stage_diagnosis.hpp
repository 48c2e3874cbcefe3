// Diagnosis of one stage between command and sensor, from its residuals to a verdict with its evidence.
//
// Thread safety: pure functions, except that the predictor runs. Deterministic for a seed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gap/diagnose/isolability.hpp"
#include "gap/diagnose/left_over.hpp"
#include "gap/diagnose/prepared_stage.hpp"
#include "gap/diagnose/stage_decision.hpp"
#include "gap/diagnose/where.hpp"

namespace kenaf::gap::diagnose {

struct StageOptions {
  DecisionSettings decision;
  double stretch_s = 1;  // of a cell
  std::uint64_t seed = 1;
};

// One effect alone.
struct SingleEvidence {
  std::size_t candidate;
  double value;
  double evidence;  // deviance gain over the nominal model
  double explains;  // share of the squared gap, on the runs it was fitted to
};

struct StageDiagnosis {
  Passage passage = Passage::command_to_drive;
  std::vector<Eigen::VectorXd> residuals;  // measured minus nominal, by run; empty if it does not measure the stage
  NoiseFloor nominal_floor;
  StageDecision decision;
  GapMeasure gap;               // with the best model, on held-out runs
  GapMeasure gap_by_manoeuvre;  // with all repeats of a manoeuvre held out together, if there are several manoeuvres
  std::vector<double> before_si, after_si;  // rms of each of diagnosis_channels(); NaN: not measured
  std::vector<Eigen::VectorXd> left;        // residual of each run with the model fitted to other runs
  GapPlaces where, where_left;
  Isolability isolability;
  std::vector<SingleEvidence> ranking;    // best first
  std::vector<Dependence> left_over;      // dependences of the residual, largest share first; none if `complete`
  std::vector<RefutedElsewhere> refuted;  // what was not searched for
  double numbers_off = 0;  // error of the description's numbers that this stage shows, for intervals (likelihood.hpp)

  bool is_measured() const { return !decision.data.groups.empty(); }
};

// Intervals allow for errors of the description's numbers (errors_of_values.hpp), and an effect that these could be
// instead has no name. `elsewhere`: findings of other stages (stage_decision.hpp).
StageDiagnosis diagnose_stage(const PreparedStage& prepared, Predictor& predictor, const StageOptions& options,
                              const Elsewhere& elsewhere = {});

}  // namespace kenaf::gap::diagnose
