// From a dataset to a verdict with its evidence: the whole diagnosis, without its reports.
//
// Deterministic: the same dataset, options and seed give the same result, on any number of threads.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gap/diagnose/next_manoeuvre.hpp"
#include "gap/diagnose/observation.hpp"
#include "gap/diagnose/prediction.hpp"
#include "gap/diagnose/stage_diagnosis.hpp"

namespace kenaf::gap::diagnose {

struct Progress {
  std::string_view doing;  // "drive to body"
  double done;             // fraction of the whole diagnosis, estimated; never decreases
};

struct DiagnosisOptions {
  std::string robot, world;          // replace the dataset's; empty: the dataset's own
  std::filesystem::path against;     // a dataset from before a change: only the change is diagnosed (baseline.hpp);
                                     // empty: none
  std::filesystem::path effects;     // a file with user-defined effects (candidates/own_effects.hpp); empty: none
  std::vector<std::string> without;  // candidates to leave out, by effect name or key, with all equivalent ones;
                                     // unknown names throw std::invalid_argument
  std::size_t most_runs = 24;        // runs that are used, at most, of a larger dataset
  logs::RefusedRuns refused_runs{};  // what to do with implausible runs
  bool propose_next = true;          // propose manoeuvres if the verdict leaves a choice
  unsigned jobs = 0;                 // threads; 0: one per core
  std::uint64_t seed = 1;
  double span_s = 0.25;  // of a bin (chosen: four in a manoeuvre's shortest event)
  double stretch_s = 1;  // of a cell
  DecisionSettings decision;
  std::function<void(const Progress&)> progress;  // called from the calling thread; may be empty
  const std::atomic<bool>* stop = nullptr;        // once true, diagnose_dataset() returns what is known so far
  Ranks ranks;                                    // processes that compute this diagnosis together
};

struct Diagnosis {
  DiagnosisOptions options;  // as used, without `progress` and `stop`
  std::string folder;        // of the dataset, as given
  Observations observations;
  ComparedFeatures features;      // less the baseline's residual, if there is one
  std::size_t baseline_runs = 0;  // baseline runs that repeat these
  // Groups of runs, as indices into observations.runs: repeats_of() and same_command_sequence_of().
  std::vector<std::vector<std::size_t>> repeats, same_command_sequence;
  std::vector<candidates::Candidate> candidates;
  std::vector<StageDiagnosis> stages;        // those that these runs measure, from command to sensor
  Verdict verdict = Verdict::unknown;        // of all stages together
  bool complete = false;                     // in every stage with a gap the residual is within noise and spread
  std::optional<std::size_t> largest_stage;  // index into `stages`: the one with most of the gap, if any
  std::vector<ProposedManoeuvre> next;       // if a stage leaves a choice between models; gentlest that suffices first
  std::vector<std::size_t> to_separate;      // the candidates that `next` is to distinguish
  std::size_t roll_outs = 0;
  std::string interrupted;  // the step at which `stop` ended the diagnosis; empty: it ran to the end
};

// Throws like observe(), observe_baseline() and candidates::read_own_effects(); runs::RunFileError if no measured
// column can be compared; std::invalid_argument if `without` has an unknown name or leaves no candidate. Once `stop` is
// true, does not throw, but returns early with `interrupted` set.
Diagnosis diagnose_dataset(const std::filesystem::path& folder, const DiagnosisOptions& options);

// `none` if all stages are; `ambiguous` if one is; else `named` if one is; else `unknown`.
Verdict whole_verdict(const std::vector<StageDiagnosis>& stages);

// A stage's gap beyond noise and spread, summed over all of its bins in squared units of noise, to compare stages.
double squared_gap(const StageDiagnosis& stage);

// All named effects, or if there are none all effects of the best models, once each. An ambiguous set contributes its
// member of the best model. An effect of several stages has the value of the stage whose interval is narrowest relative
// to the change from the present value.
Settings corrections(const Diagnosis& diagnosis);

// A readable title for a group of repeats: its manoeuvre, with its first file if other groups have the same name; the
// file alone without a name.
std::string group_title(const Diagnosis& diagnosis, std::size_t group);

}  // namespace kenaf::gap::diagnose
