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
  double done;             // share of everything, as far as it can be foreseen; never falls
};

struct DiagnosisOptions {
  std::string robot, world;       // instead of the dataset's; empty: its own
  std::filesystem::path against;  // a dataset of before a change, which alone is looked for (baseline.hpp); empty: none
  std::filesystem::path effects;  // a file with effects of one's own (candidates/own_effects.hpp); empty: none
  std::vector<std::string> without;  // candidates that are left out, by their effect's name or their key; of those that
                                     // do the same, all. Throws std::invalid_argument for others
  std::size_t most_runs = 24;        // that are used of a larger dataset
  bool propose_next = true;          // manoeuvres that would tell more, where the verdict leaves a choice
  unsigned jobs = 0;                 // threads; 0: one a core
  std::uint64_t seed = 1;
  double span_s = 0.25;  // of a bin (chosen: four to a manoeuvre's quickest event)
  double stretch_s = 1;  // of a cell
  DecisionSettings decision;
  std::function<void(const Progress&)> progress;  // called from this thread; may be empty
  const std::atomic<bool>* stop = nullptr;        // once true, what is known by then is returned
  Ranks ranks;                                    // that make this diagnosis together
};

struct Diagnosis {
  DiagnosisOptions options;  // that it was made with, without `progress` and `stop`
  Observations observations;
  ComparedFeatures features;      // less what the baseline differs by, where there is one
  std::size_t baseline_runs = 0;  // that repeat these
  std::vector<std::vector<std::size_t>> repeats, same_orders;
  std::vector<candidates::Candidate> candidates;
  std::vector<StageDiagnosis> stages;        // that these runs measure, from command to sensor
  Verdict verdict = Verdict::unknown;        // of all stages together
  bool complete = false;                     // of all stages
  std::optional<std::size_t> largest_stage;  // of `stages`: the one that holds most of the gap, where there is one
  std::vector<ProposedManoeuvre> next;  // where a stage leaves a choice between models; gentlest that suffices first
  std::vector<std::size_t> told_apart;  // the candidates between which `next` is to decide
  std::size_t roll_outs = 0;
  std::string interrupted;  // what was under way when it was stopped; empty: it is complete
};

Diagnosis diagnose_dataset(const std::filesystem::path& folder, const DiagnosisOptions& options);

// `none` where all stages are; `ambiguous` where one is; else `named` where one is; else `unknown`.
Verdict whole_verdict(const std::vector<StageDiagnosis>& stages);

// What of a stage is beyond noise and spread, summed over all of its bins in squared units of noise: by this stages
// compare.
double squared_gap(const StageDiagnosis& stage);

// Every named effect, or where nothing is named every effect of the best models, once each, at its value in the stage
// that shows it best.
Settings corrections(const Diagnosis& diagnosis);

// What people call a group of repeats: its manoeuvre; with its first file where other groups are called the same, or it
// has no name.
std::string group_title(const Diagnosis& diagnosis, std::size_t group);

}  // namespace kenaf::gap::diagnose
