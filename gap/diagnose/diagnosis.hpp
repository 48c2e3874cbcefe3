// From a dataset to a verdict with its evidence: the whole diagnosis, without its reports.
//
// Deterministic: the same dataset, options and seed give the same result, on any number of threads.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "gap/diagnose/decision.hpp"
#include "gap/diagnose/evidence.hpp"
#include "gap/diagnose/isolability.hpp"
#include "gap/diagnose/observation.hpp"
#include "gap/diagnose/stages.hpp"
#include "gap/diagnose/where.hpp"

namespace kenaf::gap {

struct Progress {
  std::string_view doing;  // "comparing effects"
  double done;             // share of everything, as far as it can be foreseen; never falls
};

struct DiagnosisOptions {
  std::string robot, world;           // instead of the dataset's; empty: its own
  std::vector<std::string> without;   // effects taken out of the catalogue; throws std::invalid_argument for others
  std::size_t most_runs = 36;         // that are used of a larger dataset
  bool propose_next = true;           // manoeuvres that would tell more, where the verdict leaves a choice
  unsigned jobs = 0;                  // threads; 0: one a core
  std::uint64_t seed = 1;
  double span_s = 0.25;               // of a bin (chosen: four to a manoeuvre's quickest event)
  double stretch_s = 1;               // of a cell
  DecisionSettings decision;
  std::function<void(const Progress&)> progress;   // called from this thread; may be empty
  const std::atomic<bool>* stop = nullptr;         // once true, what is known by then is returned
  Ranks ranks;                                     // that make this diagnosis together
};

// What one effect explains, by itself or as one of the best model.
struct EffectEvidence {
  std::size_t curve;       // of Diagnosis::curves
  Interval value;          // of its parameter
  double explains;         // share of the squared gap, on the runs it was fitted to
  Interval heldout_shrink;
  double p_value;          // of as much explained by chance
  bool at_bound;           // the fit ended at the end of the parameter's range, which is not its neutral value
};

// The gap on runs held out of the fit, in floors and in units. NaN: not measured, or not yet.
struct GapMeasure {
  static constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();
  double before = kNotMeasured, after = kNotMeasured, floor = kNotMeasured;
  Interval shrink{kNotMeasured, kNotMeasured, kNotMeasured};  // 0 where there is no model to hold out
  Interval shrink_by_manoeuvre{kNotMeasured, kNotMeasured, kNotMeasured};  // with all repeats of a manoeuvre held out
                                                                           // together, where there are several; of curves
  std::vector<double> before_si, after_si;  // of each of diagnosis_channels(); NaN: never measured
};

struct Diagnosis {
  DiagnosisOptions options;               // that it was made with, without `progress` and `stop`
  Observations observations;
  std::vector<FeatureMap> features;
  std::vector<std::vector<std::size_t>> repeats, same_orders;
  std::vector<Eigen::VectorXd> nominal;   // simulated features of each run
  NoiseFloor nominal_floor, floor;        // around the nominal model; around the best one
  GapPlaces where, where_left;            // before, and after the best model
  std::vector<StageGap> stages;           // from command to sensor
  EffectCurves curves;
  Decision decision;
  GapMeasure gap;
  std::vector<EffectEvidence> best;       // of the effects of decision.best
  std::vector<EffectEvidence> ranking;    // of all effects that these runs show, each alone, best first
  Isolability isolability;
  std::vector<NextManoeuvre> next;        // where something is ambiguous or unknown
  std::size_t roll_outs = 0;
  bool next_interrupted = false;          // `next` was asked for and not worked out; all else is complete
  std::string interrupted;                // what was under way when it was stopped; empty: it is complete
};

Diagnosis diagnose(const std::filesystem::path& folder, const DiagnosisOptions& options);

// The effects of the best model on top of those of the robot.
physics::Effects corrected_effects(const Diagnosis& diagnosis);

// What people call a group of repeats: its manoeuvre; with its first file where other groups are called the same, or it
// has no name.
std::string group_title(const Diagnosis& diagnosis, std::size_t group);

}  // namespace kenaf::gap
