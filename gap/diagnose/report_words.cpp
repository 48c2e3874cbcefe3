#include "gap/diagnose/report_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gap/diagnose/channels.hpp"

namespace kenaf::gap::diagnose {
namespace {

constexpr std::size_t kMostAlone = 3;

template <class T>
void add_once(std::vector<T>& all, const T& one) {
  if (std::ranges::find(all, one) == all.end()) all.push_back(one);
}

bool all_are_named(const StageDiagnosis& stage) {
  return std::ranges::all_of(stage.decision.effects, [](const ModelEffect& effect) { return effect.doubts.empty(); });
}

// "only 3 %", "nothing"
std::string only(double share) {
  return share >= 0.0005 ? "only " + percent(share) : "nothing";
}

// Share of all named effects together: the whole model's if it has no others.
double explained_by_names(const StageDiagnosis& stage) {
  if (all_are_named(stage)) return explained(stage);
  double sum = 0;
  for (const ModelEffect& effect : stage.decision.effects)
    if (effect.doubts.empty()) sum += explained_by(stage, effect);
  return std::min(sum, explained(stage));
}

// "drive_lag explains 85 % of the gap from command to drive".
std::string stage_in_words(const Diagnosis& d, const StageDiagnosis& stage) {
  const NamesFound names = names_found(stage);
  const bool several = names.named.size() + names.ambiguous_sets.size() > 1 ||
                       std::ranges::any_of(names.ambiguous_sets, &AmbiguousSet::may_be_several);
  std::string words = fmt::format("{} {} {} of the gap {}", names_in_words(d, names), several ? "explain" : "explains",
                                  percent(explained_by_names(stage)), from_to(stage.passage));
  const std::string together = percent(explained(stage));
  if (!all_are_named(stage) && together != percent(explained_by_names(stage)))
    words += fmt::format(" ({} together with unnamed effects)", together);
  return words + (names.ambiguous_sets.empty() ? "" : ", but these runs cannot tell which");
}

}  // namespace

std::string figure(double value) {
  if (!std::isfinite(value)) return "-";
  if (value != 0 && std::abs(value) >= 1000 && std::abs(value) < 1e6) return fmt::format("{:.0f}", value);
  return fmt::format("{:.3g}", value);
}

std::string percent(double share) {
  if (!std::isfinite(share)) return "-";
  const double size = std::abs(share);
  return size > 0.0005 && size < 0.01 ? fmt::format("{:.1f} %", share * 100)
                                      : fmt::format("{:.0f} %", std::round(share * 100) + 0.0);
}

std::string percent_interval(const Interval& share) {
  if (!std::isfinite(share.from) || !std::isfinite(share.to)) return percent(share.value);
  return fmt::format("{} ({:.0f} to {:.0f} %)", percent(share.value), std::round(share.from * 100) + 0.0,
                     std::round(share.to * 100) + 0.0);
}

std::string enumeration(std::span<const std::string> names, std::string_view last_word) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? fmt::format(" {} ", last_word) : ", ";
    text += names[i];
  }
  return text;
}

std::string unit_suffix(std::string_view unit) {
  return unit == "1" ? "" : " " + std::string(unit);
}

std::string interval_text(const Interval& interval, std::string_view unit) {
  return fmt::format("{}{} ({} to {})", figure(interval.value), unit_suffix(unit), figure(interval.from),
                     figure(interval.to));
}

NamesFound names_found(const StageDiagnosis& stage) {
  NamesFound names;
  for (const ModelEffect& effect : stage.decision.effects) {
    if (!effect.doubts.empty()) continue;
    const std::size_t place = static_cast<std::size_t>(&effect - stage.decision.effects.data());
    if (!effect.partners.empty() && effect.partners.front() < place) continue;  // already listed with its set
    if (effect.rivals.size() > 1)
      names.ambiguous_sets.push_back({effect.rivals, !effect.partners.empty()});
    else
      names.named.push_back(effect.candidate);
  }
  return names;
}

NamesFound names_found(const Diagnosis& d) {
  NamesFound names;
  if (!d.interrupted.empty()) return names;
  for (const StageDiagnosis& stage : d.stages) {
    const NamesFound of_stage = names_found(stage);
    for (const std::size_t candidate : of_stage.named) add_once(names.named, candidate);
    for (const AmbiguousSet& set : of_stage.ambiguous_sets) add_once(names.ambiguous_sets, set);
  }
  return names;
}

std::vector<std::string> candidate_names(const Diagnosis& d, std::span<const std::size_t> candidates) {
  std::vector<std::string> names;
  for (const std::size_t candidate : candidates) names.push_back(d.candidates[candidate].name);
  return names;
}

std::vector<std::string> partner_names(const Diagnosis& d, const StageDiagnosis& stage, const ModelEffect& effect) {
  std::vector<std::string> names;
  for (const std::size_t place : effect.partners)
    names.push_back(d.candidates[stage.decision.effects[place].candidate].name);
  return names;
}

std::string set_in_words(const Diagnosis& d, const AmbiguousSet& set) {
  std::vector<std::string> members = candidate_names(d, set.candidates);
  if (set.may_be_several) members.emplace_back(members.size() > 2 ? "several of them" : "both");
  return enumeration(members, "or");
}

std::string names_in_words(const Diagnosis& d, const NamesFound& names) {
  std::vector<std::string> parts = candidate_names(d, names.named);
  for (const AmbiguousSet& set : names.ambiguous_sets)
    parts.push_back((set.may_be_several ? "" : "one of ") + set_in_words(d, set));
  return enumeration(parts);
}

std::vector<std::size_t> stages_with_gap(const Diagnosis& d) {
  std::vector<std::size_t> stages;
  for (std::size_t s = 0; s < d.stages.size(); ++s)
    if (d.stages[s].decision.verdict != Verdict::none) stages.push_back(s);
  std::ranges::stable_sort(stages, std::ranges::greater{}, [&](std::size_t s) { return share_of_gap(d, s); });
  if (d.largest_stage)  // if two are equal, the one that the diagnosis chose
    if (const auto largest = std::ranges::find(stages, *d.largest_stage); largest != stages.end())
      std::rotate(stages.begin(), largest, largest + 1);
  return stages;
}

std::optional<std::size_t> main_stage(const Diagnosis& d) {
  const std::vector<std::size_t> stages = stages_with_gap(d);
  if (!stages.empty()) return stages.front();
  if (d.stages.empty()) return std::nullopt;
  return 0;
}

double share_of_gap(const Diagnosis& d, std::size_t stage) {
  const auto gap_of = [](const StageDiagnosis& of) {
    const double gap = of.decision.verdict == Verdict::none ? 0 : squared_gap(of);
    return std::isfinite(gap) ? gap : 0;
  };
  double sum = 0;
  for (const StageDiagnosis& other : d.stages) sum += gap_of(other);
  return sum > 0 ? gap_of(d.stages[stage]) / sum : 0;
}

double explained(const StageDiagnosis& stage) {
  return explained_interval(stage).value;
}

Interval explained_interval(const StageDiagnosis& stage) {
  constexpr double kUnknown = GapMeasure::kNotMeasured;
  if (stage.decision.verdict == Verdict::none) return {kUnknown, kUnknown, kUnknown};
  if (stage.decision.best.model.places.empty()) return {0, 0, 0};
  const auto within = [](double share) { return std::isnan(share) ? share : std::clamp(share, 0.0, 1.0); };
  const Interval& explains = stage.gap.explains;
  return {within(explains.value), within(explains.from), within(explains.to)};
}

namespace {
// An effect's part of the whole model's share: the latter was simulated, the parts come from curves.
double part_of_explained(const StageDiagnosis& stage, const HeldOutShares::OfEffect& share) {
  if (std::isnan(share.of_stage)) return share.of_stage;
  if (share.model_of_stage <= 0) return 0;
  return explained(stage) * std::clamp(share.of_stage / share.model_of_stage, 0.0, 1.0);
}
}  // namespace

double explained_by(const StageDiagnosis& stage, const ModelEffect& effect) {
  return stage.decision.effects.size() == 1 ? explained(stage) : part_of_explained(stage, effect.share);
}

double explained_by_set(const StageDiagnosis& stage, const ModelEffect& effect) {
  return part_of_explained(stage, effect.share_of_set);
}

std::string from_to(Passage passage) {
  return fmt::format("from {}", passage_name(passage));
}

std::string_view measured_on(const Diagnosis& d) {
  return d.observations.runs.size() > 1 ? "runs held out" : "the fitted run, the only one";
}

std::string_view noise_source(const Diagnosis& d) {
  if (d.stages.empty()) return "not measured yet";
  if (d.stages.front().nominal_floor.from_repeats) return "from the spread of repeated runs";
  return d.observations.dataset.noise.empty()
             ? "from the runs themselves, because none repeats another (less certain: a gap increases it)"
             : "as the dataset states it, else from the runs themselves, because none repeats another (less certain: a "
               "gap increases it)";
}

std::string headline(const Diagnosis& d) {
  if (!d.interrupted.empty()) return fmt::format("Unfinished: interrupted while {}", d.interrupted);
  if (d.verdict == Verdict::none)
    return "No gap: robot and simulation differ by no more than noise and repeated runs do";
  const std::vector<std::size_t> stages = stages_with_gap(d);
  if (stages.empty()) return "No stage could be compared";
  std::vector<std::string> named, unnamed;
  for (const std::size_t s : stages) {
    if (names_found(d.stages[s]).empty())
      unnamed.push_back(from_to(d.stages[s].passage));
    else
      named.push_back(stage_in_words(d, d.stages[s]));
  }
  if (named.empty()) return fmt::format("There is a gap {}, and no effect is named", enumeration(unnamed));
  if (!unnamed.empty()) named.push_back(fmt::format("no effect is named for the gap {}", enumeration(unnamed, "or")));
  std::string words = fmt::format("{}", fmt::join(named, "; "));
  if (words.starts_with("one of ")) words.front() = 'O';  // names keep their case
  return words;
}

std::string against_in_words(const Diagnosis& d) {
  if (d.options.against.empty()) return {};
  return fmt::format(
      "The gap is the change since {}, of which {} runs repeat these; a difference from the simulation that both share "
      "is not part of it",
      d.options.against.string(), d.baseline_runs);
}

std::string value_name(const candidates::Candidate& candidate) {
  if (candidate.is_number_of_description || candidate.name != candidate.effect) return candidate.name;
  return fmt::format("{} {}", candidate.name, candidate.parameter);
}

std::string value_in_words(const candidates::Candidate& candidate, const EffectValue& value) {
  std::string text =
      fmt::format("{} = {}{} (95 % interval {} to {}), {} {}", value_name(candidate), figure(value.value.value),
                  unit_suffix(candidate.unit), figure(value.value.from), figure(value.value.to),
                  candidate.is_number_of_description ? "described as" : "nominal", figure(candidate.present));
  if (value.spread > 0)
    text +=
        fmt::format(", standard deviation between manoeuvres {}{}", figure(value.spread), unit_suffix(candidate.unit));
  return text;
}

std::vector<std::string> doubts_in_words(const Diagnosis& d, const ModelEffect& effect) {
  const candidates::Candidate& candidate = d.candidates[effect.candidate];
  std::vector<std::string> words;
  // one clause per doubt with its figure; of shares, the smaller of repeats and manoeuvres held out
  for (const Doubt doubt : effect.doubts) switch (doubt) {
      case Doubt::end_of_range:
        words.push_back(fmt::format("its value is at the end of its range ({} to {}{})", figure(candidate.min),
                                    figure(candidate.max), unit_suffix(candidate.unit)));
        break;
      case Doubt::ordinary:
        words.push_back(fmt::format("a typical error of this number is as large (1 sigma: {}{})",
                                    figure(effect.ordinarily_off), unit_suffix(candidate.unit)));
        break;
      case Doubt::disagreement: {
        const double agreement = d.options.decision.agreement;
        const std::string part = agreement == 1 ? "" : fmt::format("{} of ", percent(1 / agreement));
        const std::string of_it =
            candidate.present == 0
                ? "it"
                : fmt::format("its change from {}{}", figure(candidate.present), unit_suffix(candidate.unit));
        words.push_back(fmt::format("the values fitted to single manoeuvres differ by more than {}{}", part, of_it));
        break;
      }
      case Doubt::trend:
        words.push_back(fmt::format("the values fitted to earlier and later parts of manoeuvres differ by {}{}",
                                    figure(effect.value.trend), unit_suffix(candidate.unit)));
        break;
      case Doubt::kinds_differ: {
        const FitByKind& fit = effect.value.by_kind;
        words.push_back(fmt::format("the value fitted to {} alone differs by {}{}", kind_name(fit.apart_in),
                                    figure(fit.apart), unit_suffix(candidate.unit)));
        break;
      }
      case Doubt::uncertain:
        words.push_back(fmt::format("errors of the description's numbers could be mistaken for up to {}{} of it",
                                    figure(effect.sure_from), unit_suffix(candidate.unit)));
        break;
      case Doubt::leaves_much: {
        const FitByKind& fit = effect.value.by_kind;
        words.push_back(fmt::format("{} of its size remains in {}: something that resembles it may be the cause",
                                    percent(fit.left), kind_name(fit.left_in)));
        break;
      }
      case Doubt::not_simulated:
        words.push_back(
            fmt::format("simulated on {}, the model explains too little of the stage's gap", measured_on(d)));
        break;
      case Doubt::not_predicted:
        words.push_back(
            "simulated on a manoeuvre that the fit did not have, the model explains too little of the stage's gap: "
            "drive another one that shows it");
        break;
      case Doubt::not_held_out: {
        const bool by_manoeuvre = effect.share_by_manoeuvre.of_kind < effect.share.of_kind;
        const HeldOutShares::OfEffect& least = by_manoeuvre ? effect.share_by_manoeuvre : effect.share;
        words.push_back(fmt::format("it explains {} of the gap in {} on {}", only(least.of_kind), kind_name(least.kind),
                                    by_manoeuvre ? "manoeuvres held out" : measured_on(d)));
        break;
      }
      case Doubt::negligible: {
        const auto least = [&](auto member) {
          return std::fmin(effect.share.*member, effect.share_by_manoeuvre.*member);
        };
        using Share = HeldOutShares::OfEffect;
        words.push_back(fmt::format("it explains {} of the stage's gap",
                                    only(std::min(least(&Share::of_stage), least(&Share::beyond_numbers)))));
        break;
      }
      case Doubt::little_explained: {
        const bool by_manoeuvre = effect.share_by_manoeuvre.model_of_kind < effect.share.model_of_kind;
        const HeldOutShares::OfEffect& least = by_manoeuvre ? effect.share_by_manoeuvre : effect.share;
        words.push_back(fmt::format("all effects together explain {} of the gap in {} on {}", only(least.model_of_kind),
                                    kind_name(least.kind), by_manoeuvre ? "manoeuvres held out" : measured_on(d)));
        break;
      }
    }
  return words;
}

std::vector<std::string> all_doubts(const Diagnosis& d) {
  std::vector<std::string> words;
  for (const StageDiagnosis& stage : d.stages)
    for (const ModelEffect& effect : stage.decision.effects)
      if (!effect.doubts.empty())
        words.push_back(fmt::format("not named: {} ({}): {}", d.candidates[effect.candidate].name,
                                    passage_name(stage.passage), fmt::join(doubts_in_words(d, effect), "; ")));
  return words;
}

std::string gap_in_words(const Diagnosis& d, const StageDiagnosis& stage) {
  const auto rms = [](double value) { return std::isfinite(value) ? fmt::format("{:.2f}", value) : std::string("-"); };
  const GapMeasure& gap = stage.gap;
  if (stage.decision.best.model.places.empty())
    return fmt::format("{} times the noise; noise alone: {}", rms(gap.before), rms(gap.floor));
  return fmt::format("{} times the noise before, {} after on {}; noise alone: {}", rms(gap.before), rms(gap.after),
                     measured_on(d), rms(gap.floor));
}

std::string left_in_words(const StageDiagnosis& stage) {
  if (stage.decision.verdict == Verdict::none) return {};
  if (stage.decision.complete) return "the residual is within noise and spread";
  const double share = explained(stage);
  if (share == 0) return "all of the gap remains";
  const bool some_lack_a_name = !names_found(stage).empty() && !all_are_named(stage);
  return fmt::format("{} of the gap remains{}", percent(1 - share),
                     some_lack_a_name ? ", even with the unnamed effects" : "");
}

std::vector<SingleEvidence> ranked_by_share(const StageDiagnosis& stage) {
  std::vector<SingleEvidence> ranking = stage.ranking;
  std::ranges::stable_sort(ranking, std::ranges::greater{}, [](const SingleEvidence& single) {
    return std::isnan(single.explains) ? -std::numeric_limits<double>::infinity() : single.explains;
  });
  return ranking;
}

std::vector<std::string> best_alone(const Diagnosis& d, const StageDiagnosis& stage) {
  std::vector<std::string> alone;
  for (const SingleEvidence& single : ranked_by_share(stage))
    if (alone.size() < kMostAlone && single.explains > 0.01)
      alone.push_back(fmt::format("{} ({})", d.candidates[single.candidate].name, percent(single.explains)));
  return alone;
}

std::string wrapped(std::string_view text, std::size_t width, std::string_view indent) {
  std::string result;
  std::size_t column = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const bool begins = result.empty();
    if (!begins && column + 1 + word.size() > width) {
      result += fmt::format("\n{}", indent);
      column = indent.size();
    } else if (!begins) {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size();
  }
  return result;
}

}  // namespace kenaf::gap::diagnose
