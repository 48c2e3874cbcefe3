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

std::string warnings_list(const Diagnosis& d) {
  const std::vector<std::string>& warnings = d.observations.warnings;
  if (warnings.empty()) return paragraph("No warnings.");
  std::string html = "<ul class=\"warning\">\n";
  for (std::size_t i = 0; i < std::min(kMostWarnings, warnings.size()); ++i)
    html += fmt::format("<li>{}</li>\n", plot::escaped(warnings[i]));
  if (warnings.size() > kMostWarnings) html += fmt::format("<li>and {} more</li>\n", warnings.size() - kMostWarnings);
  return html + "</ul>\n";
}

// Noise of each channel in the first stage that compares it.
std::string noise_table(const Diagnosis& d) {
  Table table{{"channel", "unit", "noise", "stated by the dataset, of a sample"}, {}, {0, 1}};
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
             "Noise of a mean over {} s, standard deviation, {}; never less than a resolution chosen for each "
             "channel:",
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
  if (!d.options.propose_next) return html + paragraph("It was not asked for.");
  if (d.next.empty())
    return html +
           paragraph(
               !d.interrupted.empty()
                   ? "It was not worked out before the diagnosis ended."
                   : "These runs leave no choice between effects that a manoeuvre could decide. Any manoeuvre that "
                     "is not in this dataset is a test of the verdict.");

  // the advice in one sentence, and how to read the figures
  html += paragraph(fmt::format("It is to tell {} apart. {}.", enumeration(candidate_names(d, d.told_apart)),
                                with_capital(advice_in_words(d.next))));
  html += paragraph(
      "Score: by how many standard deviations the two that are hardest to tell apart would differ in one run. Risks "
      "are "
      "as simulated, the worst of the robots that are still possible: they put manoeuvres in order and are no "
      "guarantee.",
      "soft");

  // one bar and one row per manoeuvre, best first
  plot::RowChart chart;
  chart.title = "How well one run of a manoeuvre would tell the candidates apart";
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

std::string used_section(const Diagnosis& d, std::span<const Overlay> overlays) {
  std::string html = section_head("used", "What was used");
  html += paragraph(fmt::format("{} runs of {} manoeuvres, {} of them drawn on this page.", d.observations.runs.size(),
                                d.repeats.size(), overlays.size()));
  if (!d.options.against.empty())
    html += paragraph(plot::escaped(against_in_words(d)) +
                      ". Overlays and residuals over time show all that differs, as measured.");
  return html + runs_table(d) + "<h3>Warnings</h3>\n" + warnings_list(d) + "<h3>Noise and options</h3>\n" +
         noise_table(d) + paragraph(options_text(d));
}

std::string method_section(const Diagnosis& d) {
  // fixed text, but for the bin width and the largest number of effects
  return section_head("method", "How it was found, and what it cannot say") +
         paragraph(
             fmt::format("The commands of each run are given to the simulated robot from the place where the "
                         "real one stood, and the means "
                         "of each channel over {} s are compared at the same times. Differences are counted in "
                         "units of noise, which "
                         "comes from repeats, and of what the simulation itself leaves open: the exact start, "
                         "the contact's stiffness "
                         "and damping, the time step, the solver's iterations. Each effect of the catalogue and each "
                         "number of the description is simulated "
                         "along its range and "
                         "fitted, alone and together with others, in each stage by itself: the body is compared in a "
                         "simulation whose tracks turn as they were measured. What the simulation cannot do "
                         "makes evidence weaker and intervals wider. How much a fit is worth is measured on runs "
                         "that it has not seen.",
                         d.options.span_s)) +
         "<ul>\n<li>A cause that is no candidate can look like one that is, if it does the same to these "
         "runs.</li>\n" +
         fmt::format("<li>No more than {} effects are fitted together in a stage; what others do is left.</li>\n",
                     d.options.decision.most_effects) +
         "<li>An interval covers noise, differences between manoeuvres and what the model leaves; not that the cause "
         "is "
         "another one.</li>\n"
         "<li>Where no run repeats another, the noise is taken from the runs themselves, and small gaps pass as "
         "noise.</li>\n"
         "<li>Accelerations are not compared, as their spikes at contacts depend on what nobody knows of the "
         "contact.</li>\n"
         "</ul>\n";
}

}  // namespace kenaf::gap::diagnose
