// The console's screen as characters, and its one line for --plain: pure functions of the known state. terminal.hpp
// displays it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "desk.hpp"
#include "link.hpp"
#include "link_health.hpp"

namespace kenaf::teleop {

// The smallest screen that has everything of the compact form, and the one of the full form. A smaller one shows its
// first rows: link and mode.
inline constexpr std::size_t kLeastRows = 20, kLeastColumns = 60;
inline constexpr std::size_t kRows = 24, kColumns = 80;
// A larger terminal is used up to this.
inline constexpr std::size_t kMostRows = 200, kMostColumns = 400;

enum class Tone : unsigned char { plain, dim, title, good, warning, alarm };

// Lines of printable ASCII only: works on every terminal and locale, and no text from the network can control the
// terminal.
struct Canvas {
  struct Cell {
    char character = ' ';
    Tone tone = Tone::plain;
  };
  std::vector<std::vector<Cell>> cells;  // rows of one length

  explicit Canvas(std::size_t rows = kRows, std::size_t columns = kColumns) : cells(rows, std::vector<Cell>(columns)) {}
  std::size_t rows() const { return cells.size(); }
  std::size_t columns() const { return cells.empty() ? 0 : cells.front().size(); }
  // Text that does not fit is truncated; non-printable characters become '?'.
  void put(std::size_t row, std::size_t column, std::string_view text, Tone tone = Tone::plain);
  std::string line(std::size_t row) const;
};

struct View {
  std::string_view control;                 // address of the control process
  std::string_view camera;                  // address of its pictures; "" = none
  std::string_view gamepad;                 // name; "" = none
  const Status* status = nullptr;           // the newest; null before the first
  std::optional<std::string_view> taken{};  // the robot belongs to another console: its description
  const LinkHealth& health;
  const Desk& desk;
  const Wish& wish;  // as it would be sent now
  double now_s;
};

// The robot from its right side, nose to the right: body, belts and flippers at their angles and at its pitch. 9 rows
// and 38 columns beginning at (row, column), each `scale` times. Front flippers '\', '/' or '-' according to their
// angle; a pair at different angles shows both.
void draw_posture(Canvas& canvas, std::size_t row, std::size_t column, const Status& status, std::size_t scale = 1);

// Of the terminal's size. From 80 x 24 on the full form; below, without the drawing, and with shorter words.
Canvas draw_screen(const View& view, std::size_t rows = kRows, std::size_t columns = kColumns);

// Such as "driving  t 8.10 s  rtt 203 ms  heard 0.04 s ago  lost 5/4 %  tracks 200 200 mm/s  nose up 23.4  flippers 57
// 57 0 0 ...".
// "-" stands for a figure that was not measured.
std::string plain_line(const View& view);

}  // namespace kenaf::teleop
