// The report on one screen.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/report.hpp"
#include "gap/diagnose/report_words.hpp"

namespace kenaf::gap::diagnose {
namespace {

constexpr std::size_t kScreenColumns = 100, kScreenLines = 40, kChannels = 4, kPhases = 3, kWarnings = 3;

class Screen {
 public:
  void add(std::string_view line, std::string_view indent = "  ") {
    const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
    text_ += std::string(line.substr(0, begin)) +
             wrapped(line.substr(begin), kScreenColumns - begin, std::string(begin, ' ') + std::string(indent)) + "\n";
  }
  std::size_t room() const {
    const auto lines = static_cast<std::size_t>(std::ranges::count(text_, '\n'));
    return lines < kScreenLines ? kScreenLines - lines : 0;
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

std::string first_line(const Diagnosis& d) {
  if (!d.interrupted.empty())
    return fmt::format("UNFINISHED: interrupted while {}; the results up to then follow", d.interrupted);
  std::string word(verdict_name(d.verdict));
  for (char& c : word) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return fmt::format("{}: {}", word, headline(d));
}

void add_stage(Screen& screen, const Diagnosis& d, std::size_t s) {
  // the stage, its share of the gap and its size before and after
  const StageDiagnosis& stage = d.stages[s];
  std::string name = from_to(stage.passage);
  name.front() = 'F';
  if (stage.decision.verdict == Verdict::none) {
    screen.add(fmt::format("{}: no gap", name));
    return;
  }
  screen.add(fmt::format("{}: {} of the whole gap; {}", name, percent(share_of_gap(d, s)), gap_in_words(d, stage)));

  // one line per effect: value, what it explains or why it has no name, partners, rivals
  for (const ModelEffect& effect : stage.decision.effects) {
    const candidates::Candidate& candidate = d.candidates[effect.candidate];
    std::string line = "  " + value_in_words(candidate, effect.value);
    if (!effect.doubts.empty())
      line += fmt::format("; not named: {}", fmt::join(doubts_in_words(d, effect), "; "));
    else
      line += fmt::format("; explains {}", percent(explained_by(stage, effect)));
    if (!effect.partners.empty())
      line += fmt::format("; with {} {}", enumeration(partner_names(d, stage, effect)),
                          percent(explained_by_set(stage, effect)));
    if (effect.doubts.empty() && effect.rivals.size() > 1)
      line +=
          fmt::format("; equally good: {}", enumeration(candidate_names(d, std::span(effect.rivals).subspan(1)), "or"));
    screen.add(line, "    ");
  }

  // what other stages refute
  for (const RefutedElsewhere& refuted : stage.refuted)
    screen.add(fmt::format("  {}: left out, as it does not fit the gap from {}", d.candidates[refuted.candidate].name,
                           passage_name(refuted.by)));

  // what is left, with the strongest dependence and what to look at
  std::string left = left_in_words(stage);
  if (!stage.left_over.empty() && !stage.decision.complete) {
    const Dependence& first = stage.left_over.front();
    left += "; " + first.words;
    if (!first.look_at.empty()) left += fmt::format("; look at {}", enumeration(first.look_at, "or"));
  }
  screen.add("  " + left, "  ");

  // without a model, the candidates that explain most alone
  if (stage.decision.effects.empty())
    if (const std::vector<std::string> alone = best_alone(d, stage); !alone.empty())
      screen.add(fmt::format("  share of the gap explained alone: {}", fmt::join(alone, ", ")));
}

void add_where(Screen& screen, const Diagnosis& d, const StageDiagnosis& stage) {
  const GapPlaces& where = stage.where;
  if (where.channels.empty() || screen.room() < kChannels + kPhases + 4) return;
  screen.add("");
  screen.add(fmt::format("Where the gap {} is:", from_to(stage.passage)));
  std::string text;
  for (std::size_t i = 0; i < std::min(kChannels, where.channels.size()); ++i) {
    const ChannelGap& gap = where.channels[i];
    if (i > 0 && gap.share < 0.005) break;
    const Channel& channel = diagnosis_channels()[gap.channel];
    screen.add(fmt::format("  {:>4}  {}: {} {} rms, noise {}", percent(gap.share), channel.column, figure(gap.rms),
                           channel.unit, figure(gap.floor)));
  }
  for (std::size_t i = 0; i < std::min(kPhases, where.phases.size()); ++i) {
    const PhaseGap& phase = where.phases[i];
    if (phase.share < 0.005) break;
    screen.add(fmt::format("  {:>4}  {}: {}, {:.1f} to {:.1f} s", percent(phase.share), group_title(d, phase.group),
                           phase.phase, phase.from_s, phase.to_s));
  }
}

}  // namespace

std::string diagnosis_text(const Diagnosis& d) {
  Screen screen;
  screen.add(first_line(d));
  screen.add(
      fmt::format("{} runs of {} manoeuvres; noise {}", d.observations.runs.size(), d.repeats.size(), noise_source(d)));
  if (!d.options.against.empty()) screen.add(against_in_words(d) + ".");
  for (std::size_t i = 0; i < std::min(kWarnings, d.observations.warnings.size()); ++i)
    screen.add(fmt::format("warning: {}", d.observations.warnings[i]));
  if (d.observations.warnings.size() > kWarnings)
    screen.add(fmt::format("and {} more warnings", d.observations.warnings.size() - kWarnings));
  if (!d.stages.empty()) screen.add("");
  for (std::size_t s = 0; s < d.stages.size(); ++s) add_stage(screen, d, s);
  if (const auto main = main_stage(d); main && d.stages[*main].decision.verdict != Verdict::none)
    add_where(screen, d, d.stages[*main]);
  if (!d.next.empty()) {
    screen.add("");
    screen.add(
        fmt::format("To distinguish {}: {}", enumeration(candidate_names(d, d.to_separate)), advice_in_words(d.next)));
  }
  if (const RobotFile robot = robot_file(d); !robot.fault.empty())
    screen.add(fmt::format("No corrected robot: {}", robot.fault));
  return screen.take();
}

}  // namespace kenaf::gap::diagnose
