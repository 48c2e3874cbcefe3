#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "gap/diagnose/page/figures.hpp"
#include "gap/diagnose/page/sections.hpp"
#include "gap/diagnose/page/words.hpp"
#include "gap/diagnose/report.hpp"
#include "gap/plot/heat_map.hpp"

namespace kenaf::gap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kUnlike_deg = 60;      // no shade from here on
constexpr std::size_t kMostPairs = 60;  // in words

double mean_angle(const MatrixXd& angle_deg, const std::vector<std::size_t>& a, const std::vector<std::size_t>& b) {
  double sum = 0;
  for (const std::size_t i : a)
    for (const std::size_t j : b) sum += angle_deg(static_cast<Index>(i), static_cast<Index>(j));
  return sum / static_cast<double>(a.size() * b.size());
}

// Both in one, with the ends side by side that are most alike.
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

std::string matrix(const Diagnosis& d, const std::vector<std::size_t>& order) {
  const Isolability& isolability = d.isolability;
  plot::HeatMap map;
  map.title = "How alike the effects look in these runs: angle between what they do, in degrees";
  map.legend =
      fmt::format("0: the same (dark); 90: nothing in common; below {:.0f} they cannot be told apart", kToldApart_deg);
  map.width_px = kWide_px;
  std::vector<std::string> names;
  for (const std::size_t i : order) names.push_back(name_of(d.curves.curves[isolability.curves[i]]));
  map.rows = map.columns = names;
  for (std::size_t r = 0; r < order.size(); ++r) {
    map.cells.emplace_back();
    for (std::size_t c = 0; c < order.size(); ++c) {
      const double angle = isolability.angle_deg(static_cast<Index>(order[r]), static_cast<Index>(order[c]));
      if (r == c)
        map.cells.back().push_back({});
      else
        map.cells.back().push_back({fmt::format("{:.0f}", angle), 1 - angle / kUnlike_deg,
                                    fmt::format("{} and {}: {:.1f} degrees", names[r], names[c], angle)});
    }
  }
  return "<div class=\"tables\">" + to_svg(map) + "</div>\n";
}

std::string pairs_in_words(const Diagnosis& d, const std::vector<std::size_t>& order) {
  std::vector<std::string> pairs;
  for (std::size_t a = 0; a < order.size(); ++a)
    for (std::size_t b = a + 1; b < order.size(); ++b) {
      const double angle = d.isolability.angle_deg(static_cast<Index>(order[a]), static_cast<Index>(order[b]));
      if (angle < kToldApart_deg)
        pairs.push_back(fmt::format("<li>{} and {} ({:.1f} degrees)</li>\n",
                                    plot::escaped(name_of(d.curves.curves[d.isolability.curves[order[a]]])),
                                    plot::escaped(name_of(d.curves.curves[d.isolability.curves[order[b]]])), angle));
    }
  if (pairs.empty()) return paragraph(fmt::format("No two effects are within {:.0f} degrees.", kToldApart_deg));
  std::string html = paragraph("These runs cannot tell apart:") + "<ul>\n";
  for (std::size_t i = 0; i < std::min(kMostPairs, pairs.size()); ++i) html += pairs[i];
  if (pairs.size() > kMostPairs) html += fmt::format("<li>and {} more pairs</li>\n", pairs.size() - kMostPairs);
  return html + "</ul>\n";
}

std::string unseen(const Diagnosis& d) {
  std::vector<std::size_t> hidden;
  for (std::size_t c = 0; c < d.curves.curves.size(); ++c)
    if (std::ranges::count(d.isolability.curves, c) == 0) hidden.push_back(c);
  if (hidden.empty()) return {};
  return paragraph(fmt::format("These runs do not show at any size, whether they are there or not: {}.",
                               enumeration(curve_names(d, hidden))));
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

std::string confusability_section(const Diagnosis& d) {
  std::string html = section_head("confusability", "What these runs can tell apart");
  if (d.isolability.curves.empty())
    return html + paragraph(d.interrupted.empty() ? "These runs show no effect of the catalogue at any size."
                                                  : "It was not worked out before the diagnosis ended.");
  html += paragraph(
      "A small amount of an effect moves all channels of all runs in some direction. The angle between the directions "
      "of two "
      "effects is a matter of the manoeuvres and the sensors alone, not of the gap.",
      "soft");
  const std::vector<std::size_t> order = look_alikes_together(d.isolability.angle_deg);
  return html + matrix(d, order) + pairs_in_words(d, order) + unseen(d);
}

}  // namespace kenaf::gap
