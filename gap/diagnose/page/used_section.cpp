// What to drive next, what the diagnosis was made from, and how.
#include <fmt/format.h>

#include <algorithm>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/page/figures.hpp"
#include "gap/diagnose/page/sections.hpp"
#include "gap/diagnose/page/words.hpp"
#include "gap/plot/row_chart.hpp"

namespace kenaf::gap {
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

std::string noise_table(const Diagnosis& d) {
  Table table{{"channel", "unit", "noise", "stated by the dataset, of a sample"}, {}, {0, 1}};
  for (std::size_t c = 0; c < d.nominal_floor.sigma.size() && c < diagnosis_channels().size(); ++c) {
    if (d.nominal_floor.sigma[c] <= 0) continue;
    const Channel& channel = diagnosis_channels()[c];
    const auto stated = d.observations.dataset.noise.find(std::string(channel.column));
    table.rows.push_back({std::string(channel.column), std::string(channel.unit), figure(d.nominal_floor.sigma[c]),
                          stated == d.observations.dataset.noise.end() ? "-" : figure(stated->second)});
  }
  if (table.rows.empty()) return {};
  return paragraph(fmt::format(
             "Noise of a mean over {} s, 1 sigma, {}; never less than a resolution chosen for each channel:",
             d.options.span_s,
             d.nominal_floor.from_repeats
                 ? "from how repeats differ"
                 : "as stated by the dataset where it is, else from the runs themselves, as none repeats another (less "
                   "sure: a gap makes it larger)")) +
         to_html(table);
}

std::string options_text(const Diagnosis& d) {
  const DiagnosisOptions& options = d.options;
  return fmt::format(
      "Robot: {}. {}Seed of resampling: {}. Bins of {} s, stretches of {} s. Chance of a verdict other than none where "
      "there is no gap: {}. Simulated runs: {}.",
      d.observations.robot_name.empty() ? "-" : d.observations.robot_name,
      options.without.empty() ? "" : fmt::format("Taken out of the catalogue: {}. ", enumeration(options.without)),
      options.seed, options.span_s, options.stretch_s, options.decision.false_alarm, d.roll_outs);
}

}  // namespace

std::string next_section(const Diagnosis& d) {
  std::string html = section_head("next", "What to drive next");
  if (!d.options.propose_next) return html + paragraph("It was not asked for.");
  if (d.next.empty()) {
    if (!d.interrupted.empty() || d.next_interrupted)
      return html + paragraph("It was not worked out before the diagnosis ended.");
    return html +
           paragraph(
               "Nothing has to be told apart. Any manoeuvre that is not in this dataset is a test of the verdict.");
  }
  html += paragraph(
      fmt::format("It is to tell apart {}. Each shipped manoeuvre is scored by how far the two that are hardest "
                  "to tell apart would differ in one run of it, in floors; below about 3, one run will "
                  "hardly decide.",
                  enumeration(curve_names(d, d.next.front().separates))));
  plot::RowChart chart;
  chart.title = "How well one run of a manoeuvre would tell the candidates apart";
  chart.x_label = "expected difference (floors)";
  for (std::size_t i = 0; i < std::min(kMostNext, d.next.size()); ++i)
    chart.rows.push_back({d.next[i].manoeuvre,
                          {{d.next[i].expected_score, plot::Shape::bar, plot::Ink::real}},
                          fmt::format("{:.1f}", d.next[i].expected_score)});
  chart.guides = {{3, "3 floors"}};
  chart.note_px = 60;
  chart.width_px = kWide_px;
  return html + to_svg(chart);
}

std::string used_section(const Diagnosis& d, std::span<const Overlay> overlays) {
  std::string html = section_head("used", "What was used");
  html += paragraph(fmt::format("{} runs of {} manoeuvres, {} of them drawn on this page.", d.observations.runs.size(),
                                d.repeats.size(), overlays.size()));
  return html + runs_table(d) + "<h3>Warnings</h3>\n" + warnings_list(d) + "<h3>Noise and options</h3>\n" +
         noise_table(d) + paragraph(options_text(d));
}

std::string method_section(const Diagnosis& d) {
  return section_head("method", "How it was found, and what it cannot say") +
         paragraph(fmt::format(
             "The commands of each run are given to the simulated robot from the place where the "
             "real one stood, and the means "
             "of each channel over {} s are compared at the same times. Differences are counted in "
             "units of noise, which "
             "comes from repeats, and of what the simulation itself leaves open: the exact start, "
             "the contact's stiffness "
             "and damping, the time step, the solver's iterations. Each effect of the catalogue is simulated "
             "along its range and "
             "fitted, alone and together with others. How much a fit is worth is measured on runs "
             "that it has not seen. What chance "
             "alone does is drawn "
             "from the noise.",
             d.options.span_s)) +
         "<ul>\n<li>A cause outside of the catalogue can look like one inside of it, if it does the same to these "
         "runs.</li>\n" +
         fmt::format("<li>No more than {} effects are fitted together; more come out as unknown.</li>\n",
                     d.options.decision.most_effects) +
         "<li>An interval covers noise, the choice of runs and the simulation's numerics; not that the model is "
         "another one.</li>\n"
         "<li>Where no run repeats another, the noise is taken from the runs themselves, and small gaps pass as "
         "noise.</li>\n"
         "<li>Accelerations are not compared, as their spikes at contacts depend on what nobody knows of the "
         "contact.</li>\n"
         "</ul>\n";
}

}  // namespace kenaf::gap
