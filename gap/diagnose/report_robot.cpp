// The corrected robot description, with comments on the part of the gap that it does not contain.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "formats/description/description_error.hpp"
#include "formats/description/description_file.hpp"
#include "gap/candidates/write_candidates.hpp"
#include "gap/diagnose/report.hpp"
#include "gap/diagnose/report_words.hpp"

namespace kenaf::gap::diagnose {
namespace {

constexpr std::size_t kCommentColumns = 100;

// Names may contain any bytes, TOML comments may not.
std::string as_comment(std::string_view text) {
  std::string line(text);
  for (char& c : line)
    if (c < 0x20 || c > 0x7e) c = '?';
  return "# " + wrapped(line, kCommentColumns - 2, "#   ") + "\n";
}

// One correction in the file, with the stage that its value comes from.
std::string contained(const Diagnosis& d, const Setting& setting) {
  std::vector<std::string> stages;
  std::string words = value_name(d.candidates[setting.candidate]);
  for (const StageDiagnosis& stage : d.stages)
    for (const ModelEffect& effect : stage.decision.effects)
      if (effect.candidate == setting.candidate) {
        stages.emplace_back(passage_name(stage.passage));
        if (effect.value.value.value == setting.value)
          words = value_in_words(d.candidates[setting.candidate], effect.value);
      }
  return fmt::format("- {} ({})", words, fmt::join(stages, ", "));
}

std::string top_of_file(const Diagnosis& d, const Settings& corrections, bool is_named) {
  // what the file contains
  std::string text =
      as_comment(is_named ? "This description contains the effects that a diagnosis of runs named:"
                          : "A CANDIDATE: a diagnosis of runs named no effect. This description contains the model "
                            "that explains most of the gap, which may have another cause:");
  for (const Setting& setting : corrections) text += as_comment(contained(d, setting));

  // what it does not contain: choices left open, the difference of a baseline
  std::vector<std::string> lacks;
  for (const AmbiguousSet& set : names_found(d).ambiguous_sets)
    lacks.push_back(fmt::format("- the choice between {}: these runs cannot distinguish them; the best fit is included",
                                set_in_words(d, set)));
  if (!d.options.against.empty())
    lacks.push_back(
        fmt::format("- the gap between {} and the simulation: the diagnosis covered only the change since then",
                    d.options.against.string()));

  // by stage: a gap without a name, effects without a name, and what the model leaves
  for (const std::size_t s : stages_with_gap(d)) {
    const StageDiagnosis& stage = d.stages[s];
    if (is_named && names_found(stage).empty())
      lacks.push_back(fmt::format("- the cause of the gap {}: no effect is named", from_to(stage.passage)));
    if (is_named)
      for (const ModelEffect& effect : stage.decision.effects)
        if (!effect.doubts.empty() &&
            std::ranges::none_of(corrections, [&](const Setting& c) { return c.candidate == effect.candidate; }))
          lacks.push_back(fmt::format("- {}, which is not named: {}", d.candidates[effect.candidate].name,
                                      fmt::join(doubts_in_words(d, effect), "; ")));
    if (stage.decision.complete) continue;
    std::string left = fmt::format("- {}: {}", from_to(stage.passage), left_in_words(stage));
    if (!stage.left_over.empty()) left += "; " + stage.left_over.front().words;
    lacks.push_back(std::move(left));
  }

  // as one block of comments
  if (lacks.empty()) return text + as_comment("Everything else in these runs is within noise and spread.") + "\n";
  text += as_comment("It does not contain:");
  for (const std::string& line : lacks) text += as_comment(line);
  return text + "\n";
}

}  // namespace

RobotFile robot_file(const Diagnosis& d) {
  RobotFile file;
  if (!d.interrupted.empty() || d.verdict == Verdict::none) return file;
  const Settings found = corrections(d);
  if (found.empty()) return file;
  const bool is_named = d.verdict == Verdict::named || d.verdict == Verdict::ambiguous;
  std::vector<std::pair<candidates::Candidate, double>> values;
  for (const Setting& setting : found) values.emplace_back(d.candidates[setting.candidate], setting.value);
  try {
    const std::string text = description::read_description_file("robot", d.observations.robot_name, ".toml").text;
    file.text = top_of_file(d, found, is_named) + candidates::robot_toml_with(text, values);
    file.name = is_named ? "robot.toml" : "robot.candidate.toml";
  } catch (const description::DescriptionError& error) {
    file.fault = error.what();
  }
  return file;
}

}  // namespace kenaf::gap::diagnose
