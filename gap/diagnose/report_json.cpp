#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/repeats.hpp"
#include "gap/diagnose/report.hpp"
#include "gap/diagnose/report_words.hpp"
#include "gap/diagnose/run_gap.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json interval_json(const Interval& interval) {
  return {number(interval.from), number(interval.to)};
}

// Shares are never above 1.
Json share_json(double share) {
  return number(std::isnan(share) ? share : std::clamp(share, 0.0, 1.0));
}

void add_names(Json& json, const Diagnosis& d, const NamesFound& names) {
  json["named"] = candidate_names(d, names.named);
  json["ambiguous_sets"] = Json::array();
  for (const AmbiguousSet& set : names.ambiguous_sets)
    json["ambiguous_sets"].push_back(candidate_names(d, set.candidates));
}

Json places_json(const Diagnosis& d, const GapPlaces& places) {
  Json json{{"channels", Json::array()}, {"phases", Json::array()}};
  for (const ChannelGap& gap : places.channels) {
    const Channel& channel = diagnosis_channels()[gap.channel];
    json["channels"].push_back({{"channel", channel.column},
                                {"unit", channel.unit},
                                {"rms", number(gap.rms)},
                                {"floor", number(gap.floor)},
                                {"share", number(gap.share)}});
  }
  for (const PhaseGap& phase : places.phases)
    json["phases"].push_back({{"manoeuvre", phase.manoeuvre},
                              {"run", d.observations.runs[representative(d.observations, d.repeats[phase.group])].file},
                              {"phase", phase.phase},
                              {"from_s", phase.from_s},
                              {"to_s", phase.to_s},
                              {"x_m", number(phase.x_m)},
                              {"y_m", number(phase.y_m)},
                              {"share", number(phase.share)}});
  return json;
}

Json where_json(const Diagnosis& d, std::optional<std::size_t> main) {
  Json where =
      main ? places_json(d, d.stages[*main].where) : Json{{"channels", Json::array()}, {"phases", Json::array()}};
  const bool has_gap = main && d.stages[*main].decision.verdict != Verdict::none;
  where["stage"] = has_gap ? Json(passage_name(d.stages[*main].passage)) : Json(nullptr);
  where["stages"] = Json::array();
  for (std::size_t s = 0; s < d.stages.size(); ++s)
    where["stages"].push_back({{"stage", passage_name(d.stages[s].passage)},
                               {"rms", number(d.stages[s].gap.before)},
                               {"floor", number(d.stages[s].gap.floor)},
                               {"share", number(share_of_gap(d, s))}});
  return where;
}

Json effect_json(const Diagnosis& d, const StageDiagnosis& stage, const ModelEffect& effect) {
  const candidates::Candidate& candidate = d.candidates[effect.candidate];
  const Interval& value = effect.value.value;
  // keys are documented in docs/gap-report.md
  return {
      {"name", candidate.effect},
      {"parameters",
       {{candidate.parameter,
         {{"value", number(value.value)},
          {"ci95", interval_json(value)},
          {"spread", number(effect.value.spread)},
          {"unit", candidate.unit},
          {"nominal", number(candidate.present)}}}}},
      {"explains", share_json(explained_by(stage, effect))},
      {"explains_by_manoeuvre", share_json(effect.share_by_manoeuvre.of_stage)},
      {"acts_most_in",
       {{"channels", kind_name(effect.share.kind)},
        {"explains", share_json(effect.share.of_kind)},
        {"explains_by_manoeuvre", share_json(effect.share_by_manoeuvre.of_kind)}}},
      {"heldout_shrink", number(stage.gap.shrink.value)},
      {"heldout_shrink_ci95", interval_json(stage.gap.shrink)},
      {"evidence", number(effect.evidence)},
      {"at_bound", effect.at_bound},
      {"is_named", effect.doubts.empty() && d.interrupted.empty()},
      {"rivals", candidate_names(d, effect.rivals)},
      {"partners", partner_names(d, stage, effect)},
      {"explains_with_partners", effect.partners.empty() ? Json(nullptr) : share_json(explained_by_set(stage, effect))},
      {"doubts", doubts_in_words(d, effect)}};
}

Json ranking_json(const Diagnosis& d, const StageDiagnosis& stage) {
  Json ranking = Json::array();
  for (const SingleEvidence& single : stage.ranking) {
    const candidates::Candidate& candidate = d.candidates[single.candidate];
    ranking.push_back(
        {{"name", candidate.effect},
         {"parameters", {{candidate.parameter, {{"value", number(single.value)}, {"unit", candidate.unit}}}}},
         {"explains", number(std::isnan(single.explains) ? single.explains : std::min(1.0, single.explains))},
         {"evidence", number(single.evidence)}});
  }
  return ranking;
}

Json si_json(const std::vector<double>& values) {
  Json result = Json::object();
  for (std::size_t c = 0; c < values.size(); ++c)
    if (!std::isnan(values[c])) result[std::string(diagnosis_channels()[c].column)] = number(values[c]);
  return result;
}

// Null if nothing was compared.
Json moment_json(const RunMoment* moment) {
  if (!moment) return nullptr;
  const ChannelMoment& most = moment->channels.front();
  const Channel& channel = diagnosis_channels()[most.channel];
  return {{"at_s", number(moment->at_s)},
          {"times_noise", number(moment->times_noise)},
          {"channel", channel.column},
          {"unit", channel.unit},
          {"measured", number(most.measured)},
          {"simulated", number(most.simulated)},
          {"difference", number(most.difference())},
          {"channel_times_noise", number(most.times_noise)}};
}

Json runs_json(const Diagnosis& d, std::span<const ComparedRun> compared_runs) {
  Json runs = Json::array();
  for (const ComparedRun& compared : compared_runs) {
    const Observation& run = d.observations.runs[compared.run];
    runs.push_back({{"run", run.file},
                    {"manoeuvre", run.manoeuvre},
                    {"times_noise", number(compared.nominal.rms)},
                    {"times_noise_corrected", compared.corrected ? number(compared.corrected->rms) : Json(nullptr)},
                    {"worst", moment_json(compared.nominal.worst_moment())}});
  }
  return runs;
}

// `stage`: null if none was diagnosed.
Json gap_json(const Diagnosis& d, const StageDiagnosis* stage) {
  const GapMeasure unknown, &gap = stage ? stage->gap : unknown,
                            &by_manoeuvre = stage ? stage->gap_by_manoeuvre : unknown;
  Json files = Json::array();
  if (stage && d.observations.runs.size() > 1)
    for (std::size_t r = 0; r < d.observations.runs.size(); ++r)
      if (r < stage->residuals.size() && stage->residuals[r].size() > 0) files.push_back(d.observations.runs[r].file);
  return {{"before", number(gap.before)},
          {"after", number(gap.after)},
          {"floor", number(gap.floor)},
          {"shrink", number(gap.shrink.value)},
          {"shrink_ci95", interval_json(gap.shrink)},
          {"shrink_by_manoeuvre", number(by_manoeuvre.shrink.value)},
          {"before_si", si_json(stage ? stage->before_si : std::vector<double>{})},
          {"after_si", si_json(stage ? stage->after_si : std::vector<double>{})},
          {"heldout_runs", files},
          {"measured_on", measured_on(d)}};
}

Json left_json(const StageDiagnosis& stage) {
  const double explains = explained(stage);
  Json left{{"share", number(1 - explains)}, {"depends_on", Json::array()}};
  for (const Dependence& dependence : stage.left_over)
    left["depends_on"].push_back({{"channel", dependence.channel},
                                  {"on", dependence.on},
                                  {"share", share_json(dependence.share)},
                                  {"slope", number(dependence.slope)},
                                  {"intercept", number(dependence.intercept)},
                                  {"unit", dependence.unit},
                                  {"on_unit", dependence.on_unit},
                                  {"words", dependence.words},
                                  {"look_at", dependence.look_at}});
  return left;
}

// `stage`: null if none was diagnosed.
Json isolability_json(const Diagnosis& d, const StageDiagnosis* stage) {
  Json json{{"effects", Json::array()}, {"angle_deg", Json::array()}};
  if (!stage) return json;
  json["effects"] = candidate_names(d, stage->isolability.candidates);
  const Eigen::MatrixXd& angle_deg = stage->isolability.angle_deg;
  for (Eigen::Index i = 0; i < angle_deg.rows(); ++i) {
    json["angle_deg"].push_back(Json::array());
    for (Eigen::Index j = 0; j < angle_deg.cols(); ++j)
      json["angle_deg"].back().push_back(number(std::round(angle_deg(i, j) * 10) / 10));
  }
  return json;
}

Json stage_json(const Diagnosis& d, std::size_t s) {
  const StageDiagnosis& stage = d.stages[s];
  const StageDecision& decision = stage.decision;
  Json json{{"stage", passage_name(stage.passage)}, {"verdict", verdict_name(decision.verdict)}};
  add_names(json, d, d.interrupted.empty() ? names_found(stage) : NamesFound{});
  json["complete"] = decision.verdict == Verdict::none || decision.complete;
  json["share_of_gap"] = number(share_of_gap(d, s));
  json["explains"] = number(explained(stage));
  json["explains_ci95"] = interval_json(explained_interval(stage));
  json["gap"] = gap_json(d, &stage);
  json["effects"] = Json::array();
  for (const ModelEffect& effect : decision.effects) json["effects"].push_back(effect_json(d, stage, effect));
  json["left"] = left_json(stage);
  json["p_gap"] = number(decision.p_gap);
  json["p_left"] = number(decision.p_left);
  json["noise_from_repeats"] = stage.nominal_floor.from_repeats;
  json["where"] = places_json(d, stage.where);
  json["ranking"] = ranking_json(d, stage);
  json["isolability"] = isolability_json(d, &stage);
  return json;
}

// Figures of the stage with most of the gap, or of the first if there is no gap. `stage`: null without stages.
void add_main_stage(Json& json, const Diagnosis& d, const StageDiagnosis* stage) {
  json["gap"] = gap_json(d, stage);
  json["ranking"] = stage ? ranking_json(d, *stage) : Json::array();
  json["p_gap"] = number(stage ? stage->decision.p_gap : GapMeasure::kNotMeasured);
  json["p_left"] = number(stage ? stage->decision.p_left : GapMeasure::kNotMeasured);
  json["isolability"] = isolability_json(d, stage);
}

}  // namespace

std::string diagnosis_json(const Diagnosis& d, std::span<const ComparedRun> runs) {
  Json json{{"format", "kenaf-gap-report/2"}, {"verdict", verdict_name(d.verdict)}};
  if (!d.interrupted.empty()) json["interrupted"] = d.interrupted;
  if (!d.options.against.empty())
    json["against"] = {{"dataset", d.options.against.string()}, {"runs", d.baseline_runs}};
  const NamesFound names = names_found(d);
  add_names(json, d, names);
  json["complete"] = d.complete && d.interrupted.empty();
  const RobotFile robot = robot_file(d);
  json["robot_file"] = robot.name.empty() ? Json(nullptr) : Json(robot.name);
  json["stages"] = Json::array();
  for (std::size_t s = 0; s < d.stages.size(); ++s) json["stages"].push_back(stage_json(d, s));
  const std::optional<std::size_t> main = main_stage(d);
  json["where"] = where_json(d, main);
  json["runs"] = runs_json(d, runs);
  json["effects"] = Json::array();
  for (const StageDiagnosis& stage : d.stages)
    for (const ModelEffect& effect : stage.decision.effects) {
      json["effects"].push_back(effect_json(d, stage, effect));
      json["effects"].back()["stage"] = passage_name(stage.passage);
    }
  add_main_stage(json, d, main ? &d.stages[*main] : nullptr);
  json["doubts"] = all_doubts(d);
  json["next_manoeuvres"] = Json::array();
  for (const ProposedManoeuvre& next : d.next)
    json["next_manoeuvres"].push_back({{"manoeuvre", next.manoeuvre},
                                       {"world", next.world},
                                       {"separates", candidate_names(d, d.to_separate)},
                                       {"expected_score", number(next.expected_score)},
                                       {"suffices", next.suffices},
                                       {"duration_s", number(next.duration_s)},
                                       {"largest_tilt_rad", number(next.risk.largest_tilt_rad)},
                                       {"fall_m", number(next.risk.fall_m)},
                                       {"impact_mps2", number(next.risk.impact_mps2)},
                                       {"current_share", number(next.risk.current_share)},
                                       {"fails", next.risk.fails},
                                       {"words", in_words(next)}});
  json["warnings"] = d.observations.warnings;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";  // names of files may hold any bytes
}

}  // namespace kenaf::gap::diagnose
