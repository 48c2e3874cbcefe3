#include "gap/diagnose/page/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gap/diagnose/report.hpp"
#include "gap/plot/chart.hpp"

namespace kenaf::gap {

using plot::escaped;

std::string figure(double value) {
  if (!std::isfinite(value)) return "-";
  if (value != 0 && std::abs(value) >= 1000 && std::abs(value) < 1e6) return fmt::format("{:.0f}", value);
  return fmt::format("{:.3g}", value);
}

std::string percent(double share) {
  if (!std::isfinite(share)) return "-";
  const double size = std::abs(share);
  return size > 0.0005 && size < 0.01 ? fmt::format("{:.1f} %", share * 100)
                                      : fmt::format("{:.0f} %", std::round(share * 100) + 0.0);
}

std::string probability(double p) {
  return p < 1e-4 ? "< 0.0001" : figure(p);
}

std::string unit_suffix(std::string_view unit) {
  return unit == "1" ? "" : " " + std::string(unit);
}

std::string interval_text(const Interval& interval, std::string_view unit) {
  return fmt::format("{:.3g}{} ({:.3g} to {:.3g})", interval.value, unit_suffix(unit), interval.from, interval.to);
}

std::string percent_interval(const Interval& share) {
  return fmt::format("{} ({:.0f} to {:.0f} %)", percent(share.value), std::round(share.from * 100) + 0.0,
                     std::round(share.to * 100) + 0.0);
}

std::string parameter_name(const EffectCurve& curve) {
  return fmt::format("{} {}", curve.effect->name, curve.parameter->name);
}

std::string enumeration(std::span<const std::string> names, std::string_view last_word) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? fmt::format(" {} ", last_word) : ", ";
    text += names[i];
  }
  return text;
}

std::vector<std::string> curve_names(const Diagnosis& d, std::span<const std::size_t> curves) {
  std::vector<std::string> names;
  for (const std::size_t curve : curves) names.push_back(name_of(d.curves.curves[curve]));
  return names;
}

std::string paragraph(std::string_view text, std::string_view classes) {
  if (classes.empty()) return fmt::format("<p>{}</p>\n", escaped(text));
  return fmt::format("<p class=\"{}\">{}</p>\n", classes, escaped(text));
}

std::string section_head(std::string_view id, std::string_view title) {
  return fmt::format("<h2 id=\"{}\">{}</h2>\n", id, escaped(title));
}

std::string to_html(const Table& table) {
  const auto cells = [&](const std::vector<std::string>& row, std::string_view tag) {
    std::string html = "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c)
      html += fmt::format("<{0}{1}>{2}</{0}>", tag,
                          std::ranges::count(table.text_columns, c) > 0 ? " class=\"text\"" : "", escaped(row[c]));
    return html + "</tr>\n";
  };
  std::string html = "<div class=\"tables\"><table>\n" + cells(table.head, "th");
  for (const std::vector<std::string>& row : table.rows) html += cells(row, "td");
  return html + "</table></div>\n";
}

}  // namespace kenaf::gap
