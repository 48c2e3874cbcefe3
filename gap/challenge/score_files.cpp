#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "gap/challenge/score.hpp"

namespace kenaf::gap::challenge {
namespace {

using Json = nlohmann::ordered_json;

std::string truth_text(const CasePlan& plan) {
  const auto size = [&](double floors, double times_background) {
    return plan.is_sized_by_background() ? fmt::format("{:.1f} times the background", times_background)
                                         : fmt::format("{:.1f} floors", floors);
  };
  if (!plan.foreign.empty())
    return fmt::format("{} by {:.2g} ({})", plan.foreign, plan.foreign_amount,
                       size(plan.foreign_floors, plan.foreign_times_background));
  if (!plan.number.key.empty())
    return fmt::format("{}={:.3g} ({})", plan.number.key, plan.number.value,
                       size(plan.number.floors, plan.number.times_background));
  if (plan.effects.empty())
    return plan.is_imperfect() ? fmt::format("nothing (a background of {:.1f} floors)", plan.background.floors)
                               : "nothing";
  std::vector<std::string> texts;
  for (const HiddenEffect& hidden : plan.effects)
    texts.push_back(fmt::format("{}:{}={:.3g} ({})", hidden.effect, hidden.parameter, hidden.value,
                                size(hidden.floors, hidden.times_background)));
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string look_alike_text(const CasePlan& plan) {
  if (!is_outside(plan.stratum)) return "";
  return fmt::format("{}, {:.1f} degrees", plan.look_alike.effect, plan.look_alike.angle_deg);
}

std::string report_text(const std::optional<ReadReport>& report) {
  if (!report) return "no report";
  std::string text = report->verdict;
  if (!report->named.empty()) text += fmt::format(": {}", fmt::join(report->named, ", "));
  for (const std::vector<std::string>& set : report->ambiguous_sets)
    text += fmt::format(" [{}]", fmt::join(set, " or "));
  return text;
}

std::string value_text(const Figure& figure, double value) {
  return figure.is_share ? fmt::format("{:.1f} %", 100 * value) : fmt::format("{:.3f}", value);
}

const char* met_text(const Figure& figure) {
  if (figure.target.empty()) return "";
  if (figure.cases == 0) return "no cases";
  return figure.met ? "met" : "**missed**";
}

std::string table(std::string_view head, const std::string& rows) {
  return rows.empty() ? "none\n" : std::string(head) + rows;
}

std::string case_rows(const std::vector<ScoredCase>& cases, bool small) {
  std::string rows;
  for (const ScoredCase& scored : cases) {
    const Judgement judgement = judge(scored.sealed.plan, scored.report);
    const bool quiet = scored.report && scored.report->verdict == "none";
    if (judgement.right || (judgement.is_small && quiet) != small) continue;
    rows += fmt::format("| {} | {} | {} | {} | {} | {} |\n", scored.sealed.plan.name,
                        stratum_name(scored.sealed.plan.stratum), truth_text(scored.sealed.plan),
                        look_alike_text(scored.sealed.plan), fmt::join(scored.sealed.plan.manoeuvres, ", "),
                        report_text(scored.report));
  }
  return table("| case | stratum | hidden | looks like | manoeuvres | report |\n|---|---|---|---|---|---|\n", rows);
}

std::string interval_rows(const std::vector<ScoredCase>& cases) {
  std::string rows;
  for (const ScoredCase& scored : cases)
    for (const ScoredInterval& interval : scored_intervals(scored))
      if (!interval.holds())
        rows += fmt::format("| {} | {} | {:.4g} | {:.4g} | {:.4g} to {:.4g} |\n", scored.sealed.plan.name,
                            interval.name, interval.hidden, interval.value, interval.from, interval.to);
  return table("| case | effect | hidden, as a model has it | value | 95 % interval |\n|---|---|---|---|---|\n", rows);
}

Json intervals_json(const ScoredCase& scored) {
  Json intervals = Json::array();
  for (const ScoredInterval& interval : scored_intervals(scored))
    intervals.push_back({{"name", interval.name},
                         {"hidden", interval.hidden},
                         {"value", interval.value},
                         {"ci95", {interval.from, interval.to}}});
  return intervals;
}

Json shrinks_json(const Shrinks& shrinks) {
  return {{"before", shrinks.before}, {"floor", shrinks.floor}, {"report", shrinks.report}, {"truth", shrinks.hidden}};
}

Json heldout_json(const std::vector<Shrinks>& of_stages) {
  Json json = Json::array();
  for (const Shrinks& shrinks : of_stages) json.push_back(shrinks_json(shrinks));
  return json;
}

Json shares_json(const ScoredCase& scored) {
  Json shares = Json::array();
  for (const ScoredShare& share : scored_shares(scored))
    shares.push_back({{"name", share.name}, {"stage", share.stage}, {"stated", share.stated}, {"truth", share.truth}});
  return shares;
}

Json case_json(const ScoredCase& scored) {
  const CasePlan& plan = scored.sealed.plan;
  const Judgement judgement = judge(plan, scored.report);
  return {{"name", plan.name},
          {"stratum", stratum_name(plan.stratum)},
          {"hidden", truth_text(plan)},
          {"looks_like", look_alike_text(plan)},
          {"report", report_text(scored.report)},
          {"small", judgement.is_small},
          {"right", judgement.right},
          {"named_alone", judgement.named_alone},
          {"can_be_told_apart", judgement.distinguishable},
          {"names_wrong", judgement.names_wrong},
          {"intervals", intervals_json(scored)},
          {"shares", shares_json(scored)},
          {"shrink_heldout", heldout_json(scored.shrinks.heldout)},
          {"shrink_unseen", scored.shrinks.unseen ? shrinks_json(*scored.shrinks.unseen) : Json(nullptr)}};
}

}  // namespace

std::string score_markdown(const std::vector<ScoredCase>& cases) {
  // The figures.
  const bool imperfect = is_imperfect(cases);
  std::string text = imperfect ? "Effects dominate where they are at least 3 times as large as the background.\n\n"
                               : "Singles, pairs, withheld and foreign ones count in the figures where what is hidden "
                                 "is at least 2 noise floors.\n\n";
  text += "| figure | of cases | value | 95 % interval | target | |\n|---|---|---|---|---|---|\n";
  for (const Figure& figure : figures(cases)) {
    if (figure.cases == 0)
      text += fmt::format("| {} | 0 | | | {} | {} |\n", figure.what, figure.target, met_text(figure));
    else
      text += fmt::format(
          "| {} | {} | {} | {} to {} | {} | {} |\n", figure.what,
          figure.is_share ? fmt::format("{} of {}", figure.hits, figure.cases) : fmt::format("{}", figure.cases),
          value_text(figure, figure.value), value_text(figure, figure.from), value_text(figure, figure.to),
          figure.target, met_text(figure));
  }

  // Tables by size, by effect, and by verdict for effects outside the catalogue.
  text += fmt::format(
      "\n### Singles by size\n\n| {} | cases | gap seen | found | named alone | wrong name "
      "|\n|---|---|---|---|---|---|\n",
      imperfect ? "times the background" : "floors");
  for (const SizeScore& size : scores_by_size(cases))
    text += fmt::format("| {} to {} | {} | {} | {} | {} | {} |\n", size.from, size.to, size.cases, size.seen,
                        size.found, size.named_alone, size.names_wrong);
  text +=
      "\n### By effect, singles and pairs of all sizes\n\n| effect | hidden | named | in a set | missed | wrong name | "
      "smallest found, floors |\n|---|---|---|---|---|---|---|\n";
  for (const EffectScore& effect : scores_by_effect(cases))
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", effect.name, effect.hidden, effect.named,
                        effect.ambiguous, effect.missed, effect.wrong,
                        effect.smallest_found_floors > 0 ? fmt::format("{:.1f}", effect.smallest_found_floors) : "");
  text +=
      "\n### Outside the catalogue, all sizes\n\n| hidden | cases | unknown | none | ambiguous | named |\n"
      "|---|---|---|---|---|---|\n";
  for (const OutsideScore& outside : scores_outside(cases))
    text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", outside.name, outside.cases, outside.unknown, outside.none,
                        outside.ambiguous, outside.named);

  // Single cases: wrong reports, missed intervals, and small effects that need not be found.
  text += "\n### Reports that are not right\n\n" + case_rows(cases, false);
  text += "\n### Intervals that do not contain the hidden value\n\n" + interval_rows(cases);
  text += imperfect ? "\n### Smaller than 3 times the background and called none: no error\n\n"
                    : "\n### Smaller than 2 floors and called none: no error\n\n";
  text += case_rows(cases, true);
  return text;
}

std::string score_json(const std::vector<ScoredCase>& cases) {
  Json json{{"format", "kenaf-gap-score/1"}, {"figures", Json::array()}, {"cases", Json::array()}};
  for (const Figure& figure : figures(cases)) {
    Json line{{"id", figure.id}, {"what", figure.what}, {"cases", figure.cases}};
    if (figure.cases > 0 && figure.is_share) line["hits"] = figure.hits;
    if (figure.cases > 0) line.update({{"value", figure.value}, {"ci95", {figure.from, figure.to}}});
    if (!figure.target.empty()) line["target"] = figure.target;
    if (!figure.target.empty() && figure.cases > 0) line["met"] = figure.met;
    json["figures"].push_back(std::move(line));
  }
  for (const ScoredCase& scored : cases) json["cases"].push_back(case_json(scored));
  return json.dump(1) + "\n";
}

}  // namespace kenaf::gap::challenge
