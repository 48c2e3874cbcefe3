#include "gap/diagnose/page/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "gap/plot/chart.hpp"

namespace kenaf::gap::diagnose {

using plot::escaped;

std::string probability(double p) {
  return p < 1e-4 ? "< 0.0001" : figure(p);
}

std::string paragraph(std::string_view text, std::string_view classes) {
  if (classes.empty()) return fmt::format("<p>{}</p>\n", escaped(text));
  return fmt::format("<p class=\"{}\">{}</p>\n", classes, escaped(text));
}

std::string section_head(std::string_view id, std::string_view title) {
  return fmt::format("<h2 id=\"{}\">{}</h2>\n", id, escaped(title));
}

std::string with_capital(std::string text) {
  if (!text.empty()) text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

std::string to_html(const Table& table) {
  const auto cells = [&](const std::vector<std::string>& row, std::string_view tag, std::string_view link = {}) {
    std::string html = "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c) {
      const bool is_linked = c < 2 && !link.empty();
      html += fmt::format(
          "<{0}{1}>{2}{3}{4}</{0}>", tag, std::ranges::count(table.text_columns, c) > 0 ? " class=\"text\"" : "",
          is_linked ? fmt::format("<a href=\"{}\">", escaped(link)) : "", escaped(row[c]), is_linked ? "</a>" : "");
    }
    return html + "</tr>\n";
  };
  std::string html =
      "<div class=\"tables\" role=\"group\" aria-label=\"Table\" tabindex=\"0\"><table>\n" + cells(table.head, "th");
  for (std::size_t r = 0; r < table.rows.size(); ++r)
    html += cells(table.rows[r], "td", r < table.row_links.size() ? std::string_view(table.row_links[r]) : "");
  return html + "</table></div>\n";
}

}  // namespace kenaf::gap::diagnose
