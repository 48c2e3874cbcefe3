#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "gap/diagnose/page/figures.hpp"
#include "gap/diagnose/page/sections.hpp"
#include "gap/diagnose/page/words.hpp"
#include "gap/plot/chart.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kUnlike_deg = 60;      // no shade beyond
constexpr std::size_t kMostPairs = 30;  // in words
constexpr std::size_t kMostShown = 24;  // of candidates: more cannot be read

double mean_angle(const MatrixXd& angle_deg, const std::vector<std::size_t>& a, const std::vector<std::size_t>& b) {
  double sum = 0;
  for (const std::size_t i : a)
    for (const std::size_t j : b) sum += angle_deg(static_cast<Index>(i), static_cast<Index>(j));
  return sum / static_cast<double>(a.size() * b.size());
}

// Joins both, with their most similar ends adjacent.
std::vector<std::size_t> joined(const MatrixXd& angle_deg, std::vector<std::size_t> a, std::vector<std::size_t> b) {
  const auto angle = [&](std::size_t i, std::size_t j) {
    return angle_deg(static_cast<Index>(i), static_cast<Index>(j));
  };
  const double best = std::min(
      {angle(a.back(), b.front()), angle(a.back(), b.back()), angle(a.front(), b.front()), angle(a.front(), b.back())});
  if (best == angle(a.front(), b.front()) || best == angle(a.front(), b.back())) std::ranges::reverse(a);
  if (angle(a.back(), b.back()) < angle(a.back(), b.front())) std::ranges::reverse(b);
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// Rows of the isolability that a page shows, in the order in which they matter.
struct ShownRows {
  std::vector<std::size_t> first;  // the effects of the best model with their rivals: what the verdict is about
  std::vector<std::size_t> rest;   // those that explain most alone, then others
};
ShownRows shown_rows(const StageDiagnosis& stage) {
  ShownRows rows;
  const std::vector<std::size_t>& candidates = stage.isolability.candidates;
  const auto add = [&](std::vector<std::size_t>& to, std::size_t candidate) {
    const auto found = std::ranges::find(candidates, candidate);
    const auto row = static_cast<std::size_t>(found - candidates.begin());
    if (found != candidates.end() && rows.first.size() + rows.rest.size() < kMostShown &&
        std::ranges::count(rows.first, row) + std::ranges::count(rows.rest, row) == 0)
      to.push_back(row);
  };
  for (const ModelEffect& effect : stage.decision.effects) add(rows.first, effect.candidate);
  for (const ModelEffect& effect : stage.decision.effects)
    for (const std::size_t rival : effect.rivals) add(rows.first, rival);
  for (const SingleEvidence& single : stage.ranking) add(rows.rest, single.candidate);
  for (const std::size_t candidate : candidates) add(rows.rest, candidate);
  return rows;
}

MatrixXd angles_between(const MatrixXd& from, const std::vector<std::size_t>& rows) {
  MatrixXd chosen(std::ssize(rows), std::ssize(rows));
  for (Index i = 0; i < chosen.rows(); ++i)
    for (Index j = 0; j < chosen.cols(); ++j)
      chosen(i, j) = from(static_cast<Index>(rows[static_cast<std::size_t>(i)]),
                          static_cast<Index>(rows[static_cast<std::size_t>(j)]));
  return chosen;
}

// Whether the decision tells two candidates apart although they shift the runs alike: one is named, and the other is no
// rival of it.
bool told_apart(const StageDiagnosis& stage, std::size_t a, std::size_t b) {
  return std::ranges::any_of(stage.decision.effects, [&](const ModelEffect& effect) {
    const std::size_t other = effect.candidate == a ? b : a;
    return (effect.candidate == a || effect.candidate == b) && effect.doubts.empty() &&
           std::ranges::find(effect.rivals, other) == effect.rivals.end();
  });
}

// A matrix of candidates, the first ones on top; `candidates`: of Diagnosis::candidates.
struct Angles {
  std::vector<std::size_t> candidates;
  std::size_t first;  // so many of them matter most, and are not folded
  MatrixXd deg;
  std::vector<std::string> names;
};

std::string angle_row(const StageDiagnosis& stage, const Angles& angles, std::size_t row) {
  std::string html = fmt::format("<tr><th scope=\"row\">{}</th>", plot::escaped(angles.names[row]));
  for (std::size_t c = 0; c < angles.names.size(); ++c) {
    if (c == row) {
      html += "<td class=\"same\" aria-label=\"itself\"></td>";
      continue;
    }
    const double deg = angles.deg(static_cast<Index>(row), static_cast<Index>(c));
    const bool apart = deg < kDistinguishable_deg && told_apart(stage, angles.candidates[row], angles.candidates[c]);
    html += fmt::format("<td style=\"--s:{:.2f}\" data-deg=\"{:.1f}\"{}>{:.0f}</td>",
                        std::clamp(1 - deg / kUnlike_deg, 0.0, 1.0), deg, apart ? " data-apart=\"\"" : "", deg);
  }
  return html + "</tr>\n";
}

// Pairs that are alike, those with an effect of the verdict first; the others are folded like the table's rows.
std::string pairs_in_words(const StageDiagnosis& stage, const Angles& angles) {
  std::vector<std::string> pairs;
  bool some_told_apart = false;
  for (std::size_t a = 0; a < angles.names.size(); ++a)
    for (std::size_t b = a + 1; b < angles.names.size(); ++b)
      if (const double deg = angles.deg(static_cast<Index>(a), static_cast<Index>(b)); deg < kDistinguishable_deg) {
        const bool apart = told_apart(stage, angles.candidates[a], angles.candidates[b]);
        some_told_apart |= apart;
        pairs.push_back(fmt::format("<li{}>{} and {} ({:.1f} degrees{})</li>\n",
                                    a < angles.first ? "" : " class=\"rest\"", plot::escaped(angles.names[a]),
                                    plot::escaped(angles.names[b]), deg, apart ? "; told apart here" : ""));
      }
  if (pairs.empty()) return paragraph(fmt::format("No two of these are within {:.0f} degrees.", kDistinguishable_deg));
  std::string html = paragraph(fmt::format("Within {:.0f} degrees, so that a small one may be taken for the other:{}",
                                           kDistinguishable_deg,
                                           some_told_apart ? " (told apart: one is named, as at its size the other, "
                                                             "fitted in its place, explains these runs worse)"
                                                           : "")) +
                     "<ul>\n";
  for (std::size_t i = 0; i < std::min(kMostPairs, pairs.size()); ++i) html += pairs[i];
  if (pairs.size() > kMostPairs)
    html += fmt::format("<li class=\"rest\">and {} more pairs</li>\n", pairs.size() - kMostPairs);
  return html + "</ul>\n";
}

// The table and the pairs: folded rows are shown by the check box before them, and always on paper.
std::string matrix(const StageDiagnosis& stage, const Angles& angles) {
  const std::string id = "all-of-" + stage_id(stage.passage);
  const std::size_t rest = angles.names.size() - angles.first;
  std::string html = fmt::format("<div class=\"angles{}\" data-alike=\"{:.0f}\">\n", angles.first > 0 ? "" : " whole",
                                 kDistinguishable_deg);
  if (rest > 0)
    html += fmt::format("<input type=\"checkbox\" id=\"{0}\"/> <label for=\"{0}\">{1}</label>\n", id,
                        angles.first > 0 ? fmt::format("show the other {} rows", rest)
                                         : fmt::format("show the table of {} candidates", rest));
  html += fmt::format("<p class=\"readout\" role=\"status\" hidden=\"hidden\" data-usual=\"{}\"></p>\n",
                      "Point at a cell, or reach the table by Tab and go on by the arrow keys.");
  html += fmt::format(
      "<div class=\"tables\" role=\"group\" aria-label=\"Angles\" tabindex=\"0\"><table>\n<caption>Angle between the "
      "shifts of two effects, in degrees. 0: "
      "identical (dark); 90: nothing in common; below {:.0f}: alike</caption>\n<thead><tr><td></td>",
      kDistinguishable_deg);
  for (const std::string& name : angles.names)
    html += fmt::format("<th scope=\"col\"><span>{}</span></th>", plot::escaped(name));
  html += "</tr></thead>\n";
  if (angles.first > 0) {
    html += "<tbody>\n";
    for (std::size_t r = 0; r < angles.first; ++r) html += angle_row(stage, angles, r);
    html += "</tbody>\n";
  }
  if (rest > 0) {
    html += "<tbody class=\"rest\">\n";
    for (std::size_t r = angles.first; r < angles.names.size(); ++r) html += angle_row(stage, angles, r);
    html += "</tbody>\n";
  }
  return html + "</table></div>\n" + pairs_in_words(stage, angles) + "</div>\n";
}

}  // namespace

std::vector<std::size_t> look_alikes_together(const MatrixXd& angle_deg) {
  std::vector<std::vector<std::size_t>> clusters;
  for (Index i = 0; i < angle_deg.rows(); ++i) clusters.push_back({static_cast<std::size_t>(i)});
  while (clusters.size() > 1) {
    std::size_t first = 0, second = 1;
    double least = 1e9;
    for (std::size_t a = 0; a < clusters.size(); ++a)
      for (std::size_t b = a + 1; b < clusters.size(); ++b)
        if (const double angle = mean_angle(angle_deg, clusters[a], clusters[b]); angle < least)
          least = angle, first = a, second = b;
    clusters[first] = joined(angle_deg, clusters[first], clusters[second]);
    clusters.erase(clusters.begin() + static_cast<std::ptrdiff_t>(second));
  }
  return clusters.empty() ? std::vector<std::size_t>{} : clusters.front();
}

std::string confusability_part(const Diagnosis& d, const StageDiagnosis& stage) {
  const Isolability& isolability = stage.isolability;
  // no candidate moves these runs at all
  if (isolability.candidates.empty())
    return "<h3>Which effects these runs can distinguish</h3>\n" +
           paragraph("No effect in this stage shows in these runs, whatever its size.");

  // what the verdict is about on top, in each part look-alikes as neighbours
  const ShownRows shown = shown_rows(stage);
  Angles angles{{}, shown.first.size(), {}, {}};
  std::vector<std::size_t> rows;
  for (const std::vector<std::size_t>& part : {shown.first, shown.rest})
    for (const std::size_t i : look_alikes_together(angles_between(isolability.angle_deg, part)))
      rows.push_back(part[i]);
  for (const std::size_t row : rows) angles.candidates.push_back(isolability.candidates[row]);
  angles.deg = angles_between(isolability.angle_deg, rows);
  angles.names = candidate_names(d, angles.candidates);

  // how to read it, what is not shown, then matrix and pairs
  std::string html = "<h3>Which effects these runs can distinguish</h3>\n";
  html += paragraph(
      "A small change of an effect shifts all channels of all runs in some direction. The angle between the directions "
      "of two effects depends on the manoeuvres and the sensors alone, not on the gap.",
      "soft");
  if (angles.first > 0)
    html += paragraph(
        "On top: the effects of the best model, and the rivals that would explain as much in their place.", "soft");
  if (rows.size() < isolability.candidates.size())
    html += paragraph(fmt::format("{} of {} candidates that show in these runs: those of the best model, and those "
                                  "that explain most alone. report.json lists all.",
                                  rows.size(), isolability.candidates.size()),
                      "soft");
  return html + matrix(stage, angles);
}

}  // namespace kenaf::gap::diagnose
