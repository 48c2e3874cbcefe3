// A picture being drawn: a cairo surface that becomes PNG or SVG, with the shapes, colours and text that the views use.
// Lengths are logical pixels; a picture is always kLogicalWidth of them wide, whatever its size in the file.
#pragma once

#include <cairo.h>

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace kenaf::draw {

using Point = Eigen::Vector2d;

inline constexpr double kLogicalWidth = 960;

struct Colour {
  double r, g, b;
};
constexpr Colour rgb(unsigned hex) {
  return {static_cast<double>(hex >> 16 & 255u) / 255, static_cast<double>(hex >> 8 & 255u) / 255,
          static_cast<double>(hex & 255u) / 255};
}

// A colour mixed with `share` of white.
constexpr Colour paler(Colour colour, double share) {
  return {colour.r + share * (1 - colour.r), colour.g + share * (1 - colour.g), colour.b + share * (1 - colour.b)};
}

namespace palette {
inline constexpr Colour kPaper = rgb(0xffffff), kPanel = rgb(0xf8f9fb), kGrid = rgb(0xe4e8ed),
                        kGridStrong = rgb(0xc9d0d8);
inline constexpr Colour kInk = rgb(0x18222f), kGreyInk = rgb(0x5d6875), kFrame = rgb(0xb6bfc9);
inline constexpr Colour kGround = rgb(0xd9d3c7), kGroundEdge = rgb(0x8b8272);
inline constexpr Colour kBox = rgb(0xcfc8bb), kBoxEdge = rgb(0x8b8272);
inline constexpr Colour kHull = rgb(0xf2b12e), kHullEdge = rgb(0x7a5406);
inline constexpr Colour kBelt = rgb(0x1c242d), kTrack = rgb(0x47535f), kFlipper = rgb(0x74818f), kWheel = rgb(0xa9b4bf);
inline constexpr Colour kRuns[] = {rgb(0x1565d8), rgb(0xd9480f), rgb(0x2b8a3e), rgb(0x9c36b5), rgb(0x0b7285)};
}  // namespace palette

// The colour of the run with that index.
Colour run_colour(std::size_t index);

enum class Format { png, svg };
enum class Align { left, centre, right };

struct Rectangle {
  double left, top, width, height;
  double right() const { return left + width; }
  double bottom() const { return top + height; }
};

class Canvas {
 public:
  Canvas(Format format, int width_px, int height_px);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  cairo_t* cairo() const { return cairo_; }
  double logical_height() const { return logical_height_; }

  void polygon(std::span<const Point> corners) const;                // makes it the current path
  void polyline(std::span<const Point> points) const;                // makes it the current path
  void circle(const Point& centre, double radius) const;             // makes it the current path
  void rectangle(const Rectangle& area) const;                       // makes it the current path
  void fill(Colour colour, double alpha = 1) const;                  // fills the current path and keeps it
  void stroke(Colour colour, double width, double alpha = 1) const;  // strokes the current path and clears it

  // Draws text with its base line at `at`; returns its width.
  double text(const Point& at, const std::string& words, double size, Colour colour, Align align = Align::left,
              bool bold = false) const;
  double text_width(const std::string& words, double size, bool bold = false) const;
  // The same with a light halo around the letters, so that it is legible on any background.
  void text_with_halo(const Point& at, const std::string& words, double size, Colour colour, Align align,
                      bool bold = false) const;

  // Returns the finished file's bytes. Nothing can be drawn afterwards.
  std::string finish();

 private:
  void set_font(double size, bool bold) const;

  std::string bytes_;  // cairo writes into it
  Format format_;
  double logical_height_;
  cairo_surface_t* surface_;
  cairo_t* cairo_;
};

}  // namespace kenaf::draw
