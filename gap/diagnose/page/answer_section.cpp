// The first screen, for readers new to such a page.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/page/sections.hpp"
#include "gap/diagnose/page/words.hpp"
#include "gap/diagnose/report.hpp"
#include "gap/plot/chart.hpp"

namespace kenaf::gap::diagnose {
namespace {

using plot::escaped;

constexpr std::size_t kMostLeftSaid = 2;  // per stage; its section has all
constexpr std::size_t kMostWorsened = 3;  // runs listed
constexpr double kWorthSaying = 0.02;     // of the whole gap: the table suffices for smaller stages without a name

std::string_view stage_meaning(Passage passage) {
  switch (passage) {
    case Passage::command_to_drive:
      return "the tracks and flippers respond to the commands differently than in the simulation";
    case Passage::drive_to_body:
      return "the body moves differently than in the simulation, with the same track motion";
    case Passage::body_to_sensor:
      return "a sensor reports a motion that differs from the motion of the body";
  }
  return {};
}

std::string bullets(const std::vector<std::string>& items) {
  if (items.size() == 1) return "<p>" + items.front() + "</p>";
  return fmt::format("<ul>\n<li>{}</li>\n</ul>", fmt::join(items, "</li>\n<li>"));
}

// One row per stage, with its share of the gap as a bar: explained by the best model, and left.
std::string stages_at_a_glance(const Diagnosis& d) {
  std::string html =
      "<div class=\"tables\" role=\"group\" aria-label=\"Stages\" tabindex=\"0\"><table class=\"glance\">\n<tr><th "
      "class=\"text\">stage</th><th class=\"text\">share of the whole gap</th>"
      "<th class=\"text\">verdict</th><th class=\"text\">explained</th></tr>\n";
  for (std::size_t s = 0; s < d.stages.size(); ++s) {
    // the bar: length by the stage's share of the gap, split into explained and left
    const StageDiagnosis& stage = d.stages[s];
    const bool has_gap = stage.decision.verdict != Verdict::none;
    const double share = share_of_gap(d, s), gone = explained(stage);
    const double gone_part = std::isnan(gone) ? 0 : share * gone;
    const NamesFound names = names_found(stage);

    // the verdict, with the names found
    std::string verdict = has_gap ? std::string(verdict_name(stage.decision.verdict)) : "no gap";
    if (!names.empty()) verdict += ": " + names_in_words(d, names);
    const std::string bar = has_gap
                                ? fmt::format(
                                      "<span class=\"share\"><span class=\"gone\" style=\"width:{:.1f}%\"></span><span "
                                      "class=\"left\" style=\"width:{:.1f}%\"></span></span> {}",
                                      100 * gone_part, 100 * (share - gone_part), percent(share))
                                : "none";
    html += fmt::format(
        "<tr><td class=\"text\"><a href=\"#{}\">{}</a></td><td class=\"text\">{}</td><td class=\"text wrap\">{}</td>"
        "<td class=\"text\">{}</td></tr>\n",
        stage_id(stage.passage), passage_name(stage.passage), bar, escaped(verdict),
        has_gap ? percent_interval(explained_interval(stage)) : "");
  }

  // a key to the two colours
  return html +
         "</table></div>\n<p class=\"soft key\"><span class=\"gone\"></span> explained by the best model, on held-out "
         "runs "
         "<span class=\"left\"></span> left unexplained</p>\n";
}

// The stages described in words.
std::vector<std::size_t> stages_described(const Diagnosis& d) {
  std::vector<std::size_t> stages = stages_with_gap(d);
  std::erase_if(stages, [&](std::size_t s) {
    return s != stages_with_gap(d).front() && share_of_gap(d, s) < kWorthSaying && names_found(d.stages[s]).empty();
  });
  return stages;
}

std::string where_is_it(const Diagnosis& d) {
  std::vector<std::string> items;
  for (const std::size_t s : stages_described(d)) {
    const StageDiagnosis& stage = d.stages[s];
    std::string item = fmt::format("{} of it is <b>{}</b>: {}", percent(share_of_gap(d, s)), from_to(stage.passage),
                                   stage_meaning(stage.passage));
    if (!stage.where.channels.empty() && stage.where.channels.front().share > 0)
      item += fmt::format(". Most of that is in {}", diagnosis_channels()[stage.where.channels.front().channel].column);
    items.push_back(item + ".");
  }
  return items.empty() ? "<p>Nowhere.</p>" : bullets(items);
}

std::string effect_item(const Diagnosis& d, const StageDiagnosis& stage, const ModelEffect& effect) {
  const candidates::Candidate& candidate = d.candidates[effect.candidate];
  const std::string words = value_in_words(candidate, effect.value);  // begins with the name
  std::string item = fmt::format("{}: <b>{}</b>{}", with_capital(from_to(stage.passage)), escaped(candidate.name),
                                 escaped(words.substr(candidate.name.size())));
  item += fmt::format("; it explains {} of the gap in {}", percent(effect.share.of_kind), kind_name(effect.share.kind));
  if (!effect.partners.empty())
    item += fmt::format("; together with {} {}, which these runs cannot attribute to the single effects",
                        escaped(enumeration(partner_names(d, stage, effect))), percent(effect.share_of_set.of_kind));
  if (effect.rivals.size() > 1)
    item += fmt::format("; {} would explain it as well",
                        escaped(enumeration(candidate_names(d, std::span(effect.rivals).subspan(1)), "or")));
  if (!candidate.summary.empty()) item += fmt::format(". <span class=\"soft\">{}</span>", escaped(candidate.summary));
  return item;
}

// With the first reason of each: the stage's own section has them all.
std::string without_name(const Diagnosis& d, const StageDiagnosis& stage) {
  std::vector<std::string> doubted;
  for (const ModelEffect& effect : stage.decision.effects)
    if (!effect.doubts.empty())
      doubted.push_back(
          fmt::format("{} ({})", d.candidates[effect.candidate].name, doubts_in_words(d, effect).front()));
  std::string item = names_found(stage).empty() ? "no effect is named. " : "";
  if (!doubted.empty()) item += fmt::format("{}ot named: {}. ", item.empty() ? 'n' : 'N', enumeration(doubted));
  if (names_found(stage).empty())
    if (const std::vector<std::string> alone = best_alone(d, stage); !alone.empty())
      item += fmt::format("Explain most of the gap alone: {}.", enumeration(alone));
  if (item.empty()) return {};
  return escaped(fmt::format("{}: {}", with_capital(from_to(stage.passage)), item));
}

std::string which_effects(const Diagnosis& d) {
  std::vector<std::string> items;
  for (const std::size_t s : stages_described(d)) {
    const StageDiagnosis& stage = d.stages[s];
    for (const ModelEffect& effect : stage.decision.effects)
      if (effect.doubts.empty()) items.push_back(effect_item(d, stage, effect));
    if (std::string others = without_name(d, stage); !others.empty()) items.push_back(std::move(others));
  }
  return items.empty() ? "<p>No effect is needed to explain the runs.</p>" : bullets(items);
}

std::string how_much(const Diagnosis& d) {
  std::vector<std::string> items;
  for (const std::size_t s : stages_described(d)) {
    const StageDiagnosis& stage = d.stages[s];
    const bool has_model = !stage.decision.best.model.places.empty();
    std::string item = fmt::format("{}: {}", with_capital(from_to(stage.passage)), gap_in_words(d, stage));
    if (has_model)
      item += fmt::format("; <b>{}</b> of the squared gap is explained", percent_interval(explained_interval(stage)));
    if (!stage.where.channels.empty()) {
      const std::size_t channel = stage.where.channels.front().channel;
      const Channel& shown = diagnosis_channels()[channel];
      if (channel < stage.before_si.size() && !std::isnan(stage.before_si[channel]))
        item += fmt::format(". {}: {} {} rms", shown.column, figure(stage.before_si[channel]), shown.unit);
      if (has_model && channel < stage.after_si.size() && !std::isnan(stage.after_si[channel]))
        item += fmt::format(" before, {} after", figure(stage.after_si[channel]));
    }
    items.push_back(item + ".");
  }
  return items.empty() ? "<p>There is nothing to explain.</p>" : bullets(items);
}

std::string what_is_left(const Diagnosis& d) {
  std::vector<std::string> items;
  for (const std::size_t s : stages_described(d)) {
    const StageDiagnosis& stage = d.stages[s];
    std::string item = fmt::format("{}: {}", with_capital(from_to(stage.passage)), left_in_words(stage));
    if (!stage.decision.complete && stage.left_over.empty()) item += "; it correlates with no measured quantity";
    for (std::size_t i = 0; !stage.decision.complete && i < std::min(kMostLeftSaid, stage.left_over.size()); ++i) {
      const Dependence& dependence = stage.left_over[i];
      item += fmt::format(". {}", escaped(with_capital(dependence.words)));
      if (!dependence.look_at.empty())
        item += fmt::format(": look at {}", escaped(enumeration(dependence.look_at, "or")));
    }
    items.push_back(item + ".");
  }
  return items.empty() ? "<p>Nothing beyond noise and the spread of repeated runs.</p>" : bullets(items);
}

std::string what_next(const Diagnosis& d) {
  std::vector<std::string> items;
  const RobotFile robot = robot_file(d);
  // one item for each verdict: which file to use, and how far to trust it
  switch (d.verdict) {
    case Verdict::none:
      return "<p>Use the simulator as it is for motions like these. Other motions may still show a gap: to look for "
             "it, drive other manoeuvres, or repeat these more often.</p>";
    case Verdict::named:
      items.emplace_back(
          d.complete
              ? "Use <b>robot.toml</b>, in the folder of this page, in place of the description: the named effects are "
                "switched on in it. Then drive a new manoeuvre and diagnose it with robot.toml: no gap should remain."
              : "Use <b>robot.toml</b>, in the folder of this page, in place of the description: the named effects are "
                "switched on in it, and a comment at its top lists what it does not contain. Diagnose new runs with it "
                "to find the causes of the remaining gap.");
      break;
    case Verdict::ambiguous:
      items.emplace_back(
          "<b>robot.toml</b>, in the folder of this page, reproduces these runs better than the description. These "
          "runs cannot identify the effect, so the file may be wrong for other motions.");
      break;
    case Verdict::unknown:
      if (!robot.name.empty())
        items.emplace_back(
            "<b>robot.candidate.toml</b>, in the folder of this page, contains the best model: it reproduces these "
            "runs better than the description, but may not be the cause. No robot.toml was written.");
      items.emplace_back(
          "Follow the signals from command to sensor and find where the gap first appears. Check the robot's "
          "description, the dimensions of the world, and the units and time stamps of the log.");
      break;
  }

  // without a valid robot there is no file, so that says all of it
  if (!robot.fault.empty())
    items = {fmt::format("No robot.toml was written, because the fitted values together make an invalid robot: {}.",
                         escaped(robot.fault))};

  // the proposed manoeuvre, or the request for one where a choice is open
  if (!d.next.empty())
    items.push_back(fmt::format("To distinguish {}: {}.", escaped(enumeration(candidate_names(d, d.to_separate))),
                                escaped(advice_in_words(d.next))));
  else if (d.verdict == Verdict::ambiguous)
    items.emplace_back(
        "Drive a manoeuvre in which these effects differ, add its runs to the dataset and diagnose again.");
  return bullets(items);
}

// The worst moment of all, with its figures; empty if nothing was compared or there is no gap.
std::string worst_moment(const Diagnosis& d, std::span<const ComparedRun> runs, std::span<const Moment> moments,
                         std::span<const Overlay> overlays) {
  const ComparedRun* worst = worst_run(runs);
  if (!worst || stages_with_gap(d).empty()) return {};
  const RunMoment& at = *worst->nominal.worst_moment();
  const Observation& run = d.observations.runs[worst->run];
  std::string place = escaped(fmt::format("{} of {} ({})", time_in_words(at.at_s), run.file, run.manoeuvre));
  for (std::size_t i = 0; i < moments.size(); ++i)
    if (overlays[moments[i].overlay].run == worst->run && moments[i].at_s == at.at_s)
      place = fmt::format("<a href=\"#{}\">{}</a>", moment_id(i), place);
  return fmt::format(
      "<p>At {} the nominal simulation is <b>{}</b> from the robot, rms of all channels (1: noise alone). "
      "It is most off in {}. Differences are measured minus simulated.</p>",
      place, times_noise_in_words(at.times_noise), escaped(in_words(at.channels.front())));
}

std::string answer(std::string_view question, std::string_view html) {
  return html.empty() ? "" : fmt::format("<dt>{}</dt>\n<dd>{}</dd>\n", question, html);
}

}  // namespace

std::vector<std::string> worsened_in_words(const Diagnosis& d, std::span<const ComparedRun> runs) {
  const std::vector<const ComparedRun*> worsened = worsened_runs(runs);
  std::vector<std::string> words;
  for (const ComparedRun* run : worsened) {
    if (words.size() == kMostWorsened) {
      words.push_back(fmt::format("The correction worsens {} more runs.", worsened.size() - words.size()));
      break;
    }
    // the channel whose squares grow most
    const ChannelCourse* most = nullptr;
    double most_growth = 0, most_before = 0;
    for (const ChannelCourse& after : run->corrected->channels) {
      const auto before = std::ranges::find(run->nominal.channels, after.channel, &ChannelCourse::channel);
      if (before == run->nominal.channels.end()) continue;
      const double growth = after.rms * after.rms - before->rms * before->rms;
      if (growth > most_growth) most = &after, most_growth = growth, most_before = before->rms;
    }
    const Observation& observed = d.observations.runs[run->run];
    std::string text = fmt::format(
        "The correction worsens {} ({}): over the whole run the corrected simulation is {} off, rms of all channels, "
        "the nominal one {}",
        observed.file, observed.manoeuvre, times_noise_in_words(run->corrected->rms),
        times_noise_in_words(run->nominal.rms));
    if (most)
      text += fmt::format("; most in {}, {} instead of {}", diagnosis_channels()[most->channel].column,
                          times_noise_in_words(most->rms), times_noise_in_words(most_before));
    words.push_back(text + ".");
  }
  return words;
}

std::string answer_section(const Diagnosis& d, std::span<const ComparedRun> runs, std::span<const Moment> moments,
                           std::span<const Overlay> overlays) {
  const bool finished = d.interrupted.empty();
  std::string html = fmt::format("<section class=\"verdict\">\n<p class=\"word\">{}</p>\n<h1>{}</h1>\n",
                                 finished ? verdict_name(d.verdict) : "unfinished", escaped(headline(d)));
  if (!d.options.against.empty()) html += paragraph(plot::escaped(against_in_words(d)) + ".", "soft");
  if (!finished)
    html += paragraph(
        "The diagnosis was interrupted. This page shows the results up to then; there is no verdict, and a missing "
        "result does not mean that nothing was found. Run the diagnosis again to its end.");
  if (!d.stages.empty()) html += stages_at_a_glance(d);
  for (const std::string& words : worsened_in_words(d, runs)) html += paragraph(words, "warning");
  if (finished && !d.stages.empty())
    html += "<dl>\n" + answer("Where is the gap?", where_is_it(d)) + answer("Which effects?", which_effects(d)) +
            answer("How much?", how_much(d)) + answer("Where is it worst?", worst_moment(d, runs, moments, overlays)) +
            answer("What is left?", what_is_left(d)) + answer("What next?", what_next(d)) + "</dl>\n";
  return html + "</section>\n";
}

}  // namespace kenaf::gap::diagnose
