#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "gap/diagnose/page/figures.hpp"
#include "gap/diagnose/page/sections.hpp"
#include "gap/diagnose/page/words.hpp"
#include "gap/plot/heat_map.hpp"

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

// Rows of the isolability: effects of the best model, their rivals, then those that explain most alone.
std::vector<std::size_t> shown_rows(const StageDiagnosis& stage) {
  std::vector<std::size_t> wanted, rows;
  for (const ModelEffect& effect : stage.decision.effects) {
    wanted.push_back(effect.candidate);
    wanted.insert(wanted.end(), effect.rivals.begin(), effect.rivals.end());
  }
  for (const SingleEvidence& single : stage.ranking) wanted.push_back(single.candidate);
  wanted.insert(wanted.end(), stage.isolability.candidates.begin(), stage.isolability.candidates.end());
  for (const std::size_t candidate : wanted) {
    const auto found = std::ranges::find(stage.isolability.candidates, candidate);
    const auto row = static_cast<std::size_t>(found - stage.isolability.candidates.begin());
    if (found != stage.isolability.candidates.end() && rows.size() < kMostShown && std::ranges::count(rows, row) == 0)
      rows.push_back(row);
  }
  return rows;
}

std::string matrix(const std::vector<std::string>& names, const MatrixXd& angle_deg) {
  plot::HeatMap map;
  map.title = "Similarity of the effects in these runs: angle between their shifts, in degrees";
  map.legend = fmt::format("0: identical (dark); 90: orthogonal; below {:.0f}: alike", kDistinguishable_deg);
  map.width_px = kWide_px;
  map.rows = map.columns = names;
  for (std::size_t r = 0; r < names.size(); ++r) {
    map.cells.emplace_back();
    for (std::size_t c = 0; c < names.size(); ++c) {
      const double angle = angle_deg(static_cast<Index>(r), static_cast<Index>(c));
      if (r == c)
        map.cells.back().push_back({});
      else
        map.cells.back().push_back({fmt::format("{:.0f}", angle), 1 - angle / kUnlike_deg,
                                    fmt::format("{} and {}: {:.1f} degrees", names[r], names[c], angle)});
    }
  }
  return "<div class=\"tables\">" + to_svg(map) + "</div>\n";
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

// `candidates`: of Diagnosis::candidates, in the order of the matrix.
std::string pairs_in_words(const Diagnosis& d, const StageDiagnosis& stage, const std::vector<std::size_t>& candidates,
                           const MatrixXd& angle_deg) {
  std::vector<std::string> pairs;
  bool some_told_apart = false;
  for (std::size_t a = 0; a < candidates.size(); ++a)
    for (std::size_t b = a + 1; b < candidates.size(); ++b)
      if (const double angle = angle_deg(static_cast<Index>(a), static_cast<Index>(b)); angle < kDistinguishable_deg) {
        const bool apart = told_apart(stage, candidates[a], candidates[b]);
        some_told_apart |= apart;
        pairs.push_back(
            fmt::format("<li>{} and {} ({:.1f} degrees{})</li>\n", plot::escaped(d.candidates[candidates[a]].name),
                        plot::escaped(d.candidates[candidates[b]].name), angle, apart ? "; told apart here" : ""));
      }
  if (pairs.empty()) return paragraph(fmt::format("No two of these are within {:.0f} degrees.", kDistinguishable_deg));
  std::string html = paragraph(fmt::format("Within {:.0f} degrees, so that a small one may be taken for the other:{}",
                                           kDistinguishable_deg,
                                           some_told_apart ? " (told apart: one is named, as at its size the other, "
                                                             "fitted in its place, explains these runs worse)"
                                                           : "")) +
                     "<ul>\n";
  for (std::size_t i = 0; i < std::min(kMostPairs, pairs.size()); ++i) html += pairs[i];
  if (pairs.size() > kMostPairs) html += fmt::format("<li>and {} more pairs</li>\n", pairs.size() - kMostPairs);
  return html + "</ul>\n";
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

  // the angles of the shown candidates, sorted so that look-alikes are neighbours
  const std::vector<std::size_t> rows = shown_rows(stage);
  const auto select = [&](const std::vector<std::size_t>& chosen, const MatrixXd& from) {
    MatrixXd selected(std::ssize(chosen), std::ssize(chosen));
    for (Index i = 0; i < selected.rows(); ++i)
      for (Index j = 0; j < selected.cols(); ++j)
        selected(i, j) = from(static_cast<Index>(chosen[static_cast<std::size_t>(i)]),
                              static_cast<Index>(chosen[static_cast<std::size_t>(j)]));
    return selected;
  };
  MatrixXd angle_deg = select(rows, isolability.angle_deg);
  const std::vector<std::size_t> order = look_alikes_together(angle_deg);
  angle_deg = select(order, angle_deg);
  std::vector<std::size_t> candidates;
  for (const std::size_t i : order) candidates.push_back(isolability.candidates[rows[i]]);
  const std::vector<std::string> names = candidate_names(d, candidates);

  // how to read it, what is not shown, then matrix and pairs
  std::string html = "<details><summary>Which effects these runs can distinguish</summary>\n";
  html += paragraph(
      "A small change of an effect shifts all channels of all runs in some direction. The angle between the directions "
      "of two effects depends on the manoeuvres and the sensors alone, not on the gap.",
      "soft");
  if (rows.size() < isolability.candidates.size())
    html += paragraph(fmt::format("{} of {} candidates that show in these runs: those of the best model, and those "
                                  "that explain most alone. report.json lists all.",
                                  rows.size(), isolability.candidates.size()),
                      "soft");
  return html + matrix(names, angle_deg) + pairs_in_words(d, stage, candidates, angle_deg) + "</details>\n";
}

}  // namespace kenaf::gap::diagnose
