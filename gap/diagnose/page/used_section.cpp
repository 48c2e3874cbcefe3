// The next manoeuvre, and the data, options and method of the diagnosis.
#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/page/figures.hpp"
#include "gap/diagnose/page/sections.hpp"
#include "gap/diagnose/page/words.hpp"
#include "gap/plot/row_chart.hpp"

namespace kenaf::gap::diagnose {
namespace {

constexpr std::size_t kMostNext = 10, kMostRepeated = 60, kMostFiles = 4, kMostWarnings = 100;

std::string files_of(const Diagnosis& d, const std::vector<std::size_t>& group) {
  std::vector<std::string> files;
  for (std::size_t i = 0; i < std::min(kMostFiles, group.size()); ++i)
    files.push_back(d.observations.runs[group[i]].file);
  if (group.size() > kMostFiles) files.push_back(fmt::format("{} more", group.size() - kMostFiles));
  return enumeration(files);
}

std::string runs_table(const Diagnosis& d) {
  Table table{{"manoeuvre", "world", "runs", "files", "lasts (s)"}, {}, {0, 1, 3}};
  for (std::size_t g = 0; g < std::min(kMostRepeated, d.repeats.size()); ++g) {
    double least = 1e9, most = 0;
    for (const std::size_t r : d.repeats[g]) {
      const double duration_s = d.observations.runs[r].replay.at_most_s();
      least = std::min(least, duration_s), most = std::max(most, duration_s);
    }
    const std::size_t world = d.observations.runs[d.repeats[g].front()].world;
    table.rows.push_back(
        {group_title(d, g), world < d.observations.worlds.size() ? d.observations.worlds[world].name : "-",
         fmt::format("{}", d.repeats[g].size()), files_of(d, d.repeats[g]),
         most - least < 0.05 ? fmt::format("{:.1f}", most) : fmt::format("{:.1f} to {:.1f}", least, most)});
  }
  std::string html = to_html(table);
  if (d.repeats.size() > kMostRepeated)
    html += paragraph(fmt::format("and {} more manoeuvres", d.repeats.size() - kMostRepeated), "soft");
  return html;
}

std::string warnings_list(const Diagnosis& d, std::span<const ComparedRun> runs) {
  std::vector<std::string> warnings = worsened_in_words(d, runs);
  warnings.insert(warnings.end(), d.observations.warnings.begin(), d.observations.warnings.end());
  if (warnings.empty()) return paragraph("No warnings.");
  std::string html = "<ul class=\"warning\">\n";
  for (std::size_t i = 0; i < std::min(kMostWarnings, warnings.size()); ++i)
    html += fmt::format("<li>{}</li>\n", plot::escaped(warnings[i]));
  if (warnings.size() > kMostWarnings) html += fmt::format("<li>and {} more</li>\n", warnings.size() - kMostWarnings);
  return html + "</ul>\n";
}

// Noise of each channel in the first stage that compares it.
std::string noise_table(const Diagnosis& d) {
  Table table{{"channel", "unit", "noise", "of a single sample, as the dataset states it"}, {}, {0, 1}};
  for (std::size_t c = 0; c < diagnosis_channels().size(); ++c) {
    const auto stage = std::ranges::find_if(d.stages, [&](const StageDiagnosis& s) {
      return c < s.nominal_floor.sigma.size() && s.nominal_floor.sigma[c] > 0;
    });
    if (stage == d.stages.end()) continue;
    const Channel& channel = diagnosis_channels()[c];
    const auto stated = d.observations.dataset.noise.find(std::string(channel.column));
    table.rows.push_back({std::string(channel.column), std::string(channel.unit), figure(stage->nominal_floor.sigma[c]),
                          stated == d.observations.dataset.noise.end() ? "-" : figure(stated->second)});
  }
  if (table.rows.empty()) return {};
  return paragraph(fmt::format(
             "Noise of a mean over {} s, standard deviation, {}; never below a resolution chosen for each channel:",
             d.options.span_s, noise_source(d))) +
         to_html(table);
}

std::string options_text(const Diagnosis& d) {
  const DiagnosisOptions& options = d.options;
  return fmt::format(
      "Robot: {}. {}{}Seed of resampling: {}. Bins of {} s, stretches of {} s. Chance of a verdict other than none "
      "where "
      "there is no gap: {}. Simulated runs: {}.",
      d.observations.robot_name.empty() ? "-" : d.observations.robot_name,
      options.without.empty() ? "" : fmt::format("Left out: {}. ", enumeration(options.without)),
      options.effects.empty() ? "" : fmt::format("Own effects: {}. ", options.effects.string()), options.seed,
      options.span_s, options.stretch_s, options.decision.false_alarm, d.roll_outs);
}

}  // namespace

std::string next_section(const Diagnosis& d) {
  std::string html = section_head("next", "What to drive next");
  // no proposal: say why
  if (!d.options.propose_next) return html + paragraph("No proposal was requested.");
  if (d.next.empty())
    return html + paragraph(!d.interrupted.empty() ? "The diagnosis ended before a manoeuvre could be proposed."
                                                   : "These runs leave no effects to distinguish. Any manoeuvre that "
                                                     "is not in this dataset tests the verdict.");

  // the advice in one sentence, and how to read the figures
  html += paragraph(fmt::format("The manoeuvre is to distinguish {}. {}.",
                                enumeration(candidate_names(d, d.to_separate)), with_capital(advice_in_words(d.next))));
  html += paragraph(
      "Score: expected difference in one run, in standard deviations, between the two candidates that are hardest to "
      "distinguish. Risks are simulated, for the worst of the robots that are still possible: they rank the manoeuvres "
      "and guarantee nothing.",
      "soft");

  // one bar and one row per manoeuvre, best first
  plot::RowChart chart;
  chart.title = "How well one run of a manoeuvre would distinguish the candidates";
  chart.x_label = "expected difference (standard deviations)";
  Table table{{"manoeuvre", "world", "lasts (s)", "score", "tilt (degrees)", "fall (mm)", "impact (m/s^2)",
               "of the stall current", "suffices"},
              {},
              {0, 1, 8}};
  for (std::size_t i = 0; i < std::min(kMostNext, d.next.size()); ++i) {
    const ProposedManoeuvre& next = d.next[i];
    chart.rows.push_back({next.manoeuvre,
                          {{next.expected_score, plot::Shape::bar, plot::Ink::real, {}}},
                          fmt::format("{:.1f}", next.expected_score)});
    table.rows.push_back({next.manoeuvre, next.world, fmt::format("{:.0f}", next.duration_s),
                          fmt::format("{:.1f}", next.expected_score),
                          fmt::format("{:.0f}", next.risk.largest_tilt_rad * 180 / std::numbers::pi),
                          fmt::format("{:.0f}", next.risk.fall_m * 1000), figure(next.risk.impact_mps2),
                          percent(next.risk.current_share),
                          next.risk.fails ? "no, the robot may turn over"
                          : next.suffices ? "yes"
                                          : "no"});
  }

  // the chart above the table, with the score that suffices as a guide
  chart.guides = {{kSuffices, "suffices"}};
  chart.note_px = 60;
  chart.width_px = kWide_px;
  return html + to_svg(chart) + to_html(table);
}

std::string used_section(const Diagnosis& d, std::span<const Overlay> overlays, std::span<const ComparedRun> runs) {
  std::string html = section_head("used", "What was used");
  html += paragraph(fmt::format("{} runs of {} manoeuvres; {} of them are plotted on this page.",
                                d.observations.runs.size(), d.repeats.size(), overlays.size()));
  if (!d.options.against.empty())
    html += paragraph(plot::escaped(against_in_words(d)) +
                      ". Overlays and residuals over time show all that differs, as measured.");
  return html + runs_table(d) + "<h3>Warnings</h3>\n" + warnings_list(d, runs) + "<h3>Noise and options</h3>\n" +
         noise_table(d) + paragraph(options_text(d));
}

std::string method_section(const Diagnosis& d) {
  // fixed text, but for the bin width and the largest number of effects
  return section_head("method", "Method and limits") +
         paragraph(fmt::format(
             "The simulated robot receives the commands of each run from the measured initial state, and the means of "
             "each channel over {} s are compared at the same times. Differences are scaled by the noise, which is "
             "estimated from repeated runs where there are any, and by the uncertainty of the simulation itself: the "
             "exact start, the "
             "contact stiffness and damping, the time step, the solver iterations. Each effect of the catalogue and "
             "each number of the description is simulated over its range and fitted, alone and together with others, "
             "in each stage separately: for the body, the simulated tracks move as measured. Model discrepancy weakens "
             "evidence and widens intervals. Each fit is validated on held-out runs.",
             d.options.span_s)) +
         "<ul>\n<li>A cause that is not a candidate can be mistaken for a candidate with the same influence on these "
         "runs.</li>\n" +
         fmt::format(
             "<li>At most {} effects are fitted together in a stage; further effects remain unexplained.</li>\n",
             d.options.decision.most_effects) +
         "<li>An interval covers noise, differences between manoeuvres and the residual of the model, but not the "
         "possibility of another cause.</li>\n"
         "<li>Where no run repeats another, the noise is estimated from the runs themselves, and small gaps count as "
         "noise.</li>\n"
         "<li>Accelerations are not compared, because their spikes at contacts depend on unknown contact "
         "parameters.</li>\n"
         "</ul>\n";
}

}  // namespace kenaf::gap::diagnose
