#include "tools/draw/canvas.hpp"

#include <cairo-svg.h>

#include <iterator>
#include <numbers>
#include <stdexcept>

namespace kenaf::draw {

namespace {

cairo_status_t append(void* bytes, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

void check(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS) {
    throw std::runtime_error(std::string("the picture cannot be drawn: ") + cairo_status_to_string(status));
  }
}

}  // namespace

Colour run_colour(std::size_t index) {
  return palette::kRuns[index % std::size(palette::kRuns)];
}

Canvas::Canvas(Format format, int width_px, int height_px)
    : format_(format), logical_height_(height_px * kLogicalWidth / width_px) {
  surface_ = format == Format::png ? cairo_image_surface_create(CAIRO_FORMAT_RGB24, width_px, height_px)
                                   : cairo_svg_surface_create_for_stream(append, &bytes_, width_px, height_px);
  cairo_ = cairo_create(surface_);
  const double scale = width_px / kLogicalWidth;
  cairo_scale(cairo_, scale, scale);
  cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(cairo_, CAIRO_LINE_CAP_ROUND);
  // Without hinting, which would make letter widths differ between PNG and SVG.
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(cairo_, options);
  cairo_font_options_destroy(options);
  rectangle({0, 0, kLogicalWidth, logical_height_});
  fill(palette::kPaper);
  cairo_new_path(cairo_);
}

Canvas::~Canvas() {
  cairo_destroy(cairo_);
  cairo_surface_destroy(surface_);
}

void Canvas::polyline(std::span<const Point> points) const {
  cairo_new_path(cairo_);
  for (const Point& point : points) cairo_line_to(cairo_, point.x(), point.y());
}

void Canvas::polygon(std::span<const Point> corners) const {
  polyline(corners);
  cairo_close_path(cairo_);
}

void Canvas::circle(const Point& centre, double radius) const {
  cairo_new_path(cairo_);
  cairo_arc(cairo_, centre.x(), centre.y(), radius, 0, 2 * std::numbers::pi);
  cairo_close_path(cairo_);
}

void Canvas::rectangle(const Rectangle& area) const {
  cairo_new_path(cairo_);
  cairo_rectangle(cairo_, area.left, area.top, area.width, area.height);
}

void Canvas::fill(Colour colour, double alpha) const {
  cairo_set_source_rgba(cairo_, colour.r, colour.g, colour.b, alpha);
  cairo_fill_preserve(cairo_);
}

void Canvas::stroke(Colour colour, double width, double alpha) const {
  cairo_set_source_rgba(cairo_, colour.r, colour.g, colour.b, alpha);
  cairo_set_line_width(cairo_, width);
  cairo_stroke(cairo_);
}

void Canvas::set_font(double size, bool bold) const {
  cairo_select_font_face(cairo_, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo_, size);
}

double Canvas::text_width(const std::string& words, double size, bool bold) const {
  set_font(size, bold);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo_, words.c_str(), &extents);
  return extents.x_advance;
}

double Canvas::text(const Point& at, const std::string& words, double size, Colour colour, Align align,
                    bool bold) const {
  const double width = text_width(words, size, bold);
  const double shift = align == Align::left ? 0 : align == Align::centre ? width / 2 : width;
  cairo_move_to(cairo_, at.x() - shift, at.y());
  cairo_set_source_rgb(cairo_, colour.r, colour.g, colour.b);
  cairo_show_text(cairo_, words.c_str());
  cairo_new_path(cairo_);
  return width;
}

void Canvas::text_with_halo(const Point& at, const std::string& words, double size, Colour colour, Align align,
                            bool bold) const {
  const double width = text_width(words, size, bold);
  const double shift = align == Align::left ? 0 : align == Align::centre ? width / 2 : width;
  cairo_new_path(cairo_);
  cairo_move_to(cairo_, at.x() - shift, at.y());
  cairo_text_path(cairo_, words.c_str());
  stroke(palette::kPanel, 4, 0.9);
  text(at, words, size, colour, align, bold);
}

std::string Canvas::finish() {
  check(cairo_status(cairo_));
  cairo_surface_flush(surface_);
  if (format_ == Format::png) check(cairo_surface_write_to_png_stream(surface_, append, &bytes_));
  cairo_surface_finish(surface_);
  check(cairo_surface_status(surface_));
  return bytes_;
}

}  // namespace kenaf::draw
