#include "gap/plot/svg.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gap/plot/chart.hpp"

namespace kenaf::gap::plot {

namespace {

constexpr double kSvgTitleBase_px = 16;
constexpr double kMeanLetter_px = 7.2;  // about the mean width of a letter at the font size of 13
constexpr std::string_view kLink = "<a href=";
constexpr double kMostShade = 0.62;  // largest opacity: text on it keeps a contrast of 4.5 in both themes

}  // namespace

std::string svg_chart(std::string_view title, double width_px, double height_px, std::string_view contents,
                      double title_x_px) {
  const bool has_links = contents.find(kLink) != std::string_view::npos;
  return fmt::format(
      "<svg class=\"chart\" xmlns=\"http://www.w3.org/2000/svg\" role=\"{5}\" aria-label=\"{0}\" width=\"{1:.0f}\" "
      "height=\"{2:.0f}\" viewBox=\"0 0 {1:.0f} {2:.0f}\">\n<text class=\"title\" x=\"{3:.0f}\" y=\"{4}\">{0}</text>\n"
      "{6}</svg>\n",
      escaped(title), width_px, height_px, title_x_px, kSvgTitleBase_px, has_links ? "group" : "img", contents);
}

std::string text_at(double x_px, double y_px, std::string_view text, std::string_view classes) {
  if (text.empty()) return {};
  if (classes.empty()) return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", x_px, y_px, escaped(text));
  return fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", classes, x_px, y_px, escaped(text));
}

double text_width_px(std::string_view text) {
  return kMeanLetter_px * static_cast<double>(text.size());
}

std::string end_of(std::string_view text, double width_px) {
  if (text_width_px(text) <= width_px) return std::string(text);
  const auto is_inside_letter = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; };  // of UTF-8
  while (!text.empty() && (text_width_px(text) + kMeanLetter_px > width_px || is_inside_letter(text.front())))
    text.remove_prefix(1);
  return "\u2026" + std::string(text);
}

std::string linked(std::string svg, std::string_view link) {
  return link.empty() ? svg : fmt::format("{}\"{}\">{}</a>", kLink, escaped(link), svg);
}

std::string shaded_box(double x_px, double y_px, double width_px, double height_px, double strength,
                       std::string_view hint) {
  return fmt::format(
      "<rect class=\"shade\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
      "fill-opacity=\"{:.2f}\">{}</rect>",
      x_px, y_px, width_px, height_px, kMostShade * std::clamp(strength, 0.0, 1.0),
      hint.empty() ? "" : fmt::format("<title>{}</title>", escaped(hint)));
}

}  // namespace kenaf::gap::plot
