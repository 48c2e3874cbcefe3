// Phrases shared by text, page and files of a report.
//
// Thread safety: pure functions.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnose/diagnosis.hpp"

namespace kenaf::gap::diagnose {

// Three significant digits; "-" if unknown.
std::string figure(double value);
// A share, as "71 %", small ones as "0.4 %".
std::string percent(double share);
// "71 % (65 to 80 %)".
std::string percent_interval(const Interval& share);
// "a, b and c".
std::string enumeration(std::span<const std::string> names, std::string_view last_word = "and");
// " m/s"; empty for a ratio.
std::string unit_suffix(std::string_view unit);
// "0.0513 s (0.0498 to 0.0528)".
std::string interval_text(const Interval& interval, std::string_view unit);

// Candidates of effects that these runs cannot distinguish.
struct AmbiguousSet {
  std::vector<std::size_t> candidates;
  bool may_be_several;  // the model has several of them, which explain enough only together
  bool operator==(const AmbiguousSet&) const = default;
};
// Candidates of effects with a name of their own, and sets.
struct NamesFound {
  std::vector<std::size_t> named;
  std::vector<AmbiguousSet> ambiguous_sets;
  bool empty() const { return named.empty() && ambiguous_sets.empty(); }
};
// Empty for an interrupted diagnosis.
NamesFound names_found(const StageDiagnosis& stage);
NamesFound names_found(const Diagnosis& d);  // of all stages, each once
std::vector<std::string> candidate_names(const Diagnosis& d, std::span<const std::size_t> candidates);
// Names of the effects with which together it explains enough.
std::vector<std::string> partner_names(const Diagnosis& d, const StageDiagnosis& stage, const ModelEffect& effect);
// "com_forward or ground_slope"; if it may be several, "command_slew, drive_lag or both".
std::string set_in_words(const Diagnosis& d, const AmbiguousSet& set);
// "drive_lag and one of com_forward or ground_slope".
std::string names_in_words(const Diagnosis& d, const NamesFound& names);

// Indices into Diagnosis::stages of those with a gap, largest first.
std::vector<std::size_t> stages_with_gap(const Diagnosis& d);
// The one with most of the gap; without any gap the first one. Empty if no stage was diagnosed.
std::optional<std::size_t> main_stage(const Diagnosis& d);
// Share of the squared gap of all stages.
double share_of_gap(const Diagnosis& d, std::size_t stage);
// Share of a stage's squared gap that the best model explains, from 0 to 1; NaN without a gap.
double explained(const StageDiagnosis& stage);
// Its interval, from 0 to 1.
Interval explained_interval(const StageDiagnosis& stage);
// The share that one effect explains, as its part of the model's share. A single effect has the model's share.
double explained_by(const StageDiagnosis& stage, const ModelEffect& effect);
// The share that it explains with its partners.
double explained_by_set(const StageDiagnosis& stage, const ModelEffect& effect);

std::string from_to(Passage passage);  // "from command to drive"
// The runs on which gap and shrink were measured: "runs held out"; with a single run, "the run fitted to, as there is
// no other".
std::string_view measured_on(const Diagnosis& d);
// The source of the noise: "from how repeats differ".
std::string_view noise_source(const Diagnosis& d);

// The whole verdict in one sentence, without a full stop.
std::string headline(const Diagnosis& d);
// "The gap is what changed since before, of which 12 runs repeat these; ...". Without a full stop; empty without a
// baseline.
std::string against_in_words(const Diagnosis& d);
// "command_slew slowness_s2pm"; only the name if it contains the parameter.
std::string value_name(const candidates::Candidate& candidate);
// "command_slew slowness_s2pm = 0.69 s^2/m (95 % interval 0.65 to 0.72), nominal 0". Begins with the candidate's name.
std::string value_in_words(const candidates::Candidate& candidate, const EffectValue& value);
// Why an effect of the best model gets no name: "its value is at the end of its range (0 to 3 s)".
std::vector<std::string> doubts_in_words(const Diagnosis& d, const ModelEffect& effect);
// "not named: com_forward (drive to body): ...", for all effects of all stages.
std::vector<std::string> all_doubts(const Diagnosis& d);
// "8.10 times the noise before, 1.90 after on runs held out; noise alone: 1.00".
std::string gap_in_words(const Diagnosis& d, const StageDiagnosis& stage);
// The residual of a stage's best model: "15 % of the gap is left", "what is left is within noise and spread". Empty
// without a gap.
std::string left_in_words(const StageDiagnosis& stage);
// StageDiagnosis::ranking by the share that each explains, largest first.
std::vector<SingleEvidence> ranked_by_share(const StageDiagnosis& stage);
// If no effect is named, the candidates that explain most alone, at most three: "com_forward (31 %)"; empty: none.
std::vector<std::string> best_alone(const Diagnosis& d, const StageDiagnosis& stage);

// Wraps text at `width` columns, with `indent` before all lines but the first; longer words stay whole.
std::string wrapped(std::string_view text, std::size_t width, std::string_view indent);

}  // namespace kenaf::gap::diagnose
