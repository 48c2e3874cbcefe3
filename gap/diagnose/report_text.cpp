// The verdict, and the report on one screen.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/report.hpp"

namespace kenaf::gap {
namespace {

constexpr std::size_t kChannels = 5, kPhases = 4, kRanking = 6, kNext = 3, kWarnings = 3;

std::string value_text(const Diagnosis& d, const EffectEvidence& e) {
  const EffectCurve& curve = d.curves.curves[e.curve];
  const std::string unit = curve.parameter->unit == "1" ? "" : " " + std::string(curve.parameter->unit);
  return fmt::format("{} {} = {:.4g}{} ({:.4g} to {:.4g})", curve.effect->name, curve.parameter->name, e.value.value,
                     unit, e.value.from, e.value.to);
}

std::string set_text(const Diagnosis& d, const std::vector<std::size_t>& curves) {
  std::vector<std::string> names;
  for (const std::size_t curve : curves) names.push_back(name_of(d.curves.curves[curve]));
  return names.size() == 1 ? names.front() : fmt::format("one of {{{}}}", fmt::join(names, ", "));
}

std::string_view noise_source(const Diagnosis& d) {
  if (d.floor.whiteners.empty()) return "not measured yet";
  if (d.floor.from_repeats) return "from their repeats";
  return d.observations.dataset.noise.empty()
             ? "from the runs themselves, as none repeats another: less sure"
             : "as stated, or from the runs themselves, as none repeats another: less sure";
}

std::string verdict_line(const Diagnosis& d) {
  if (!d.interrupted.empty())
    return fmt::format("UNFINISHED: interrupted while {}; what is known until then follows", d.interrupted);
  std::vector<std::string> sets;
  for (const std::vector<std::size_t>& rivals : d.decision.rivals) sets.push_back(set_text(d, rivals));
  switch (d.decision.verdict) {
    case Verdict::none:
      return "NONE: no gap beyond the noise and the spread of repeats";
    case Verdict::named:
      return fmt::format("NAMED: {}", fmt::join(sets, " and "));
    case Verdict::ambiguous:
      return fmt::format("AMBIGUOUS: {}; these runs cannot tell them apart", fmt::join(sets, " and "));
    case Verdict::unknown:
      return "UNKNOWN: a gap that the effects of the catalogue do not explain, alone or together";
  }
  return {};
}

}  // namespace

std::string_view verdict_name(Verdict verdict) {
  constexpr std::string_view kNames[] = {"none", "named", "ambiguous", "unknown"};
  return kNames[static_cast<std::size_t>(verdict)];
}

std::string_view measured_on(const Diagnosis& d) {
  return d.observations.runs.size() > 1 ? "runs held out" : "the run fitted to, as there is no other";
}

std::string name_of(const EffectCurve& curve) {
  return curve.effect->parameters.size() == 1 ? std::string(curve.effect->name)
                                              : fmt::format("{}:{}", curve.effect->name, curve.parameter->name);
}

std::string_view gap_stage(const Diagnosis& d) {
  const Verdict verdict = d.decision.verdict;
  if ((verdict == Verdict::named || verdict == Verdict::ambiguous) && !d.decision.best.places.empty())
    return physics::stage_name(d.curves.curves[d.decision.best.places.front().curve].effect->stage);
  constexpr physics::Stage kOfPassage[] = {physics::Stage::drive, physics::Stage::body, physics::Stage::sensor};
  for (const StageGap& stage : d.stages)
    if (stage.chance > kStageChance) return physics::stage_name(kOfPassage[static_cast<std::size_t>(stage.passage)]);
  return physics::stage_name(physics::Stage::body);
}

std::vector<std::string> doubts_in_words(const Decision& decision) {
  const auto chance = [](double p) { return p < 1e-4 ? std::string("p < 0.0001") : fmt::format("p = {:.2g}", p); };
  std::vector<std::string> words;
  for (const Doubt doubt : decision.doubts) switch (doubt) {
      case Doubt::much_left:
        words.push_back(fmt::format("more is left than chance leaves ({})", chance(decision.p_left)));
        break;
      case Doubt::left_in_drive:
        words.push_back(fmt::format("in {} {:.0f} % of the squared gap is left, more than chance leaves ({})",
                                    diagnosis_channels()[decision.left_in_drive->channel].column,
                                    100 * decision.left_in_drive->share, chance(decision.left_in_drive->p)));
        break;
      case Doubt::disagreement:
        words.push_back(fmt::format("manoeuvres want different values ({})", chance(decision.p_agree)));
        break;
      case Doubt::end_of_range:
        words.push_back("a value at the end of its range stands for something that its effect cannot do");
        break;
      case Doubt::trifle:
        words.push_back("of so many effects one accounts for too little");
        break;
      case Doubt::undone:
        words.push_back(fmt::format(
            "effects undo each other: one of them moves {} by {:.0f} floors, all together by {:.0f}",
            diagnosis_channels()[decision.undone->channel].column, decision.undone->alone, decision.undone->together));
        break;
      case Doubt::not_held_out:
        words.push_back("on runs held out too little of the gap is gone");
        break;
      case Doubt::beyond_repeats:
        words.push_back("on runs held out more is left than repeats differ by");
        break;
    }
  return words;
}

std::string diagnosis_text(const Diagnosis& d) {
  std::string text = verdict_line(d) + "\n";
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{} runs of {} manoeuvres; noise {}\n", d.observations.runs.size(), d.repeats.size(),
                 noise_source(d));
  for (std::size_t i = 0; i < std::min(kWarnings, d.observations.warnings.size()); ++i)
    fmt::format_to(out, "warning: {}\n", d.observations.warnings[i]);
  if (d.observations.warnings.size() > kWarnings)
    fmt::format_to(out, "and {} more warnings\n", d.observations.warnings.size() - kWarnings);
  for (const EffectEvidence& e : d.best)
    fmt::format_to(out, "  {}{}\n", value_text(d, e), e.at_bound ? "  AT THE END OF ITS RANGE" : "");
  for (const std::string& doubt : doubts_in_words(d.decision)) fmt::format_to(out, "  no name: {}\n", doubt);
  if (d.interrupted.empty()) {
    fmt::format_to(out, "\nGap on {}, in noise floors: {:.2f} before", measured_on(d), d.gap.before);
    if (!d.best.empty())
      fmt::format_to(out, ", {:.2f} after; {:.0f} % of what is beyond {:.2f} is gone ({:.0f} to {:.0f} %)", d.gap.after,
                     d.gap.shrink.value * 100, d.gap.floor, d.gap.shrink.from * 100, d.gap.shrink.to * 100);
    fmt::format_to(out, "\n");
  }
  if (d.decision.verdict != Verdict::none && !d.stages.empty()) {
    fmt::format_to(out, "\nWhere: {}\n", gap_stage(d));
    for (const StageGap& stage : d.stages)
      if (stage.bins > 0)
        fmt::format_to(out, "  {:<17} {:>6.2f} floors rms, {:.1f} times chance\n", passage_name(stage.passage),
                       stage.rms, stage.chance);
    for (std::size_t i = 0; i < std::min(kChannels, d.where.channels.size()); ++i) {
      const ChannelGap& gap = d.where.channels[i];
      const Channel& channel = diagnosis_channels()[gap.channel];
      fmt::format_to(out, "  {:<18} {:>9.4g} {:<6} rms, noise {:>9.4g}, {:>3.0f} % of the gap\n", channel.column,
                     gap.rms, channel.unit, gap.floor, gap.share * 100);
    }
    for (std::size_t i = 0; i < std::min(kPhases, d.where.phases.size()); ++i) {
      const PhaseGap& phase = d.where.phases[i];
      fmt::format_to(out, "  {:<24} {:<13} {:>5.1f} to {:>5.1f} s  {:>3.0f} % of the gap\n",
                     group_title(d, phase.group), phase.phase, phase.from_s, phase.to_s, phase.share * 100);
    }
  }
  if (d.decision.verdict != Verdict::none && !d.ranking.empty()) {
    fmt::format_to(out, "\nEach effect alone, by what it takes off {}:\n", measured_on(d));
    for (std::size_t i = 0; i < std::min(kRanking, d.ranking.size()); ++i)
      fmt::format_to(out, "  {:>4.0f} %  {}\n", d.ranking[i].heldout_shrink.value * 100, value_text(d, d.ranking[i]));
  }
  if (d.next_interrupted) fmt::format_to(out, "\nWhat would tell more was not worked out: interrupted\n");
  if (!d.next.empty()) {
    fmt::format_to(out, "\nWhat would tell more: ");
    for (std::size_t i = 0; i < std::min(kNext, d.next.size()); ++i)
      fmt::format_to(out, "{}{} ({:.1f} floors)", i > 0 ? ", " : "", d.next[i].manoeuvre, d.next[i].expected_score);
    fmt::format_to(out, "\n");
  }
  return text;
}

}  // namespace kenaf::gap
