#include "tools/draw/axes.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kenaf::draw {

namespace {

constexpr double kTickSpacing = 36;  // least distance of two lines, pixels
constexpr double kTickSize = 11.5;
constexpr double kShownInMillimetres_m = 1.5;

double step_of(const Mapping& map) {
  return round_step(kTickSpacing / map.pixels_per_metre());
}

std::string tick_label(double value_m, double step_m, bool millimetres) {
  if (millimetres) return fmt::format("{:.0f}", std::round(value_m * 1000) + 0.0);
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step_m) - 1e-9)));
  return fmt::format("{:.{}f}", std::abs(value_m) < step_m / 2 ? 0.0 : value_m, decimals);
}

template <class Draw>
void each_multiple(double low, double high, double step, Draw draw) {
  for (double n = std::ceil(low / step); n * step <= high; ++n) draw(n * step);
}

void line(const Canvas& canvas, const Point& a, const Point& b, Colour colour, double width) {
  const Point ends[] = {a, b};
  canvas.polyline(ends);
  canvas.stroke(colour, width);
}

}  // namespace

Rectangle inside_labels(const Rectangle& area) {
  constexpr double kLeft = 60, kBottom = 42, kTop = 26;
  return {area.left + kLeft, area.top + kTop, area.width - kLeft, area.height - kTop - kBottom};
}

double round_step(double at_least) {
  const double decade = std::pow(10, std::floor(std::log10(at_least)));
  for (const double factor : {1, 2, 5}) {
    if (factor * decade >= at_least) return factor * decade;
  }
  return 10 * decade;
}

void draw_grid(const Canvas& canvas, const Mapping& map) {
  canvas.rectangle(map.area);
  canvas.fill(palette::kPanel);
  cairo_new_path(canvas.cairo());
  const double step = step_of(map);
  each_multiple(map.low.x(), map.high.x(), step, [&](double x) {
    const double at = map({x, 0}).x();
    line(canvas, {at, map.area.top}, {at, map.area.bottom()}, x == 0 ? palette::kGridStrong : palette::kGrid, 1);
  });
  each_multiple(map.low.y(), map.high.y(), step, [&](double y) {
    const double at = map({0, y}).y();
    line(canvas, {map.area.left, at}, {map.area.right(), at}, y == 0 ? palette::kGridStrong : palette::kGrid, 1);
  });
}

void draw_labels(const Canvas& canvas, const Mapping& map, const std::string& caption, const std::string& right_name,
                 const std::string& up_name) {
  // Small areas are labelled in millimetres.
  const double step = step_of(map);
  const bool millimetres = map.high.x() - map.low.x() < kShownInMillimetres_m;
  const std::string unit = millimetres ? " [mm]" : " [m]";

  // Frame, and a number at each grid line.
  const Rectangle& area = map.area;
  canvas.rectangle(area);
  canvas.stroke(palette::kFrame, 1);
  each_multiple(map.low.x(), map.high.x(), step, [&](double x) {
    canvas.text({map({x, 0}).x(), area.bottom() + 17}, tick_label(x, step, millimetres), kTickSize, palette::kGreyInk,
                Align::centre);
  });
  each_multiple(map.low.y(), map.high.y(), step, [&](double y) {
    canvas.text({area.left - 8, map({0, y}).y() + 4}, tick_label(y, step, millimetres), kTickSize, palette::kGreyInk,
                Align::right);
  });

  // Names of the axes, the upward one turned by 90 degrees, and the caption.
  canvas.text({area.left + area.width / 2, area.bottom() + 35}, right_name + unit, kTickSize, palette::kGreyInk,
              Align::centre);
  cairo_save(canvas.cairo());
  cairo_translate(canvas.cairo(), area.left - 46, area.top + area.height / 2);
  cairo_rotate(canvas.cairo(), -1.5707963267948966);
  canvas.text({0, 0}, up_name + unit, kTickSize, palette::kGreyInk, Align::centre);
  cairo_restore(canvas.cairo());
  canvas.text({area.left, area.top - 10}, caption, 13, palette::kInk, Align::left, true);
}

}  // namespace kenaf::draw
