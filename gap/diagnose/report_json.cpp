#include <cmath>
#include <nlohmann/json.hpp>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/repeats.hpp"
#include "gap/diagnose/report.hpp"

namespace kenaf::gap {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json names_of(const Diagnosis& d, const std::vector<std::size_t>& curves) {
  Json names = Json::array();
  for (const std::size_t curve : curves) names.push_back(name_of(d.curves.curves[curve]));
  return names;
}

Json where_json(const Diagnosis& d) {
  Json where{{"stage", d.stages.empty() ? Json(nullptr) : Json(gap_stage(d))},
             {"stages", Json::array()},
             {"channels", Json::array()},
             {"phases", Json::array()}};
  for (const StageGap& stage : d.stages)
    if (stage.bins > 0)
      where["stages"].push_back({{"passage", passage_name(stage.passage)},
                                 {"rms", number(stage.rms)},
                                 {"energy_over_chance", number(stage.chance)}});
  for (const ChannelGap& gap : d.where.channels) {
    const Channel& channel = diagnosis_channels()[gap.channel];
    where["channels"].push_back({{"channel", channel.column},
                                 {"unit", channel.unit},
                                 {"rms", number(gap.rms)},
                                 {"floor", number(gap.floor)},
                                 {"share", number(gap.share)}});
  }
  for (const PhaseGap& phase : d.where.phases)
    where["phases"].push_back(
        {{"manoeuvre", phase.manoeuvre},
         {"run", d.observations.runs[representative(d.observations, d.repeats[phase.group])].file},
         {"phase", phase.phase},
         {"from_s", phase.from_s},
         {"to_s", phase.to_s},
         {"x_m", number(phase.x_m)},
         {"y_m", number(phase.y_m)},
         {"share", number(phase.share)}});
  return where;
}

Json effect_json(const Diagnosis& d, const EffectEvidence& evidence) {
  const EffectCurve& curve = d.curves.curves[evidence.curve];
  return {{"name", curve.effect->name},
          {"parameters",
           {{std::string(curve.parameter->name),
             {{"value", evidence.value.value}, {"ci95", {evidence.value.from, evidence.value.to}}}}}},
          {"heldout_shrink", number(evidence.heldout_shrink.value)},
          {"heldout_shrink_ci95", {number(evidence.heldout_shrink.from), number(evidence.heldout_shrink.to)}},
          {"explains", number(evidence.explains)},
          {"p_value", evidence.p_value},
          {"at_bound", evidence.at_bound}};
}

Json si_json(const std::vector<double>& values) {
  Json result = Json::object();
  for (std::size_t c = 0; c < values.size(); ++c)
    if (!std::isnan(values[c])) result[std::string(diagnosis_channels()[c].column)] = values[c];
  return result;
}

Json gap_json(const Diagnosis& d) {
  Json files = Json::array();
  if (d.observations.runs.size() > 1 && std::isfinite(d.gap.before))
    for (const Observation& run : d.observations.runs) files.push_back(run.file);
  return {{"before", number(d.gap.before)},
          {"after", number(d.gap.after)},
          {"floor", number(d.gap.floor)},
          {"shrink", number(d.gap.shrink.value)},
          {"shrink_ci95", {number(d.gap.shrink.from), number(d.gap.shrink.to)}},
          {"shrink_by_manoeuvre", number(d.gap.shrink_by_manoeuvre.value)},
          {"before_si", si_json(d.gap.before_si)},
          {"after_si", si_json(d.gap.after_si)},
          {"heldout_runs", files},
          {"measured_on", measured_on(d)}};
}

}  // namespace

std::string diagnosis_json(const Diagnosis& d) {
  Json json{{"format", "kenaf-gap-report/1"}, {"verdict", verdict_name(d.decision.verdict)}};
  if (!d.interrupted.empty()) json["interrupted"] = d.interrupted;
  const Model& best = d.decision.best;
  const bool named = d.decision.verdict == Verdict::named || d.decision.verdict == Verdict::ambiguous;
  json["named"] = Json::array();
  json["ambiguous_sets"] = Json::array();
  for (std::size_t i = 0; named && i < best.places.size(); ++i) {
    const std::vector<std::size_t>& rivals = d.decision.rivals[i];
    if (rivals.size() > 1)
      json["ambiguous_sets"].push_back(names_of(d, rivals));
    else
      json["named"].push_back(name_of(d.curves.curves[best.places[i].curve]));
  }
  json["where"] = where_json(d);
  json["effects"] = Json::array();
  for (const EffectEvidence& evidence : d.best) json["effects"].push_back(effect_json(d, evidence));
  json["ranking"] = Json::array();
  for (const EffectEvidence& evidence : d.ranking) json["ranking"].push_back(effect_json(d, evidence));
  json["gap"] = gap_json(d);
  json["p_gap"] = number(d.decision.p_gap);
  json["p_left"] = number(d.decision.p_left);
  json["p_agree"] = number(d.decision.p_agree);
  json["doubts"] = doubts_in_words(d.decision);
  Json angles = Json::array();
  for (Eigen::Index i = 0; i < d.isolability.angle_deg.rows(); ++i) {
    angles.push_back(Json::array());
    for (Eigen::Index j = 0; j < d.isolability.angle_deg.cols(); ++j)
      angles.back().push_back(std::round(d.isolability.angle_deg(i, j) * 10) / 10);
  }
  json["isolability"] = {{"effects", names_of(d, d.isolability.curves)}, {"angle_deg", angles}};
  json["next_manoeuvres"] = Json::array();
  for (const NextManoeuvre& next : d.next)
    json["next_manoeuvres"].push_back({{"manoeuvre", next.manoeuvre},
                                       {"separates", names_of(d, next.separates)},
                                       {"expected_score", number(next.expected_score)}});
  json["warnings"] = d.observations.warnings;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";  // names of files may hold any bytes
}

}  // namespace kenaf::gap
