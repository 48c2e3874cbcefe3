// The console's screen as characters, and its one line for --plain: pure functions of the known state. terminal.hpp
// displays it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "desk.hpp"
#include "link.hpp"
#include "link_health.hpp"

namespace kenaf::teleop {

inline constexpr std::size_t kRows = 24, kColumns = 80;

enum class Tone : unsigned char { plain, dim, title, good, warning, alarm };

// 24 lines of 80 characters, printable ASCII only: works on every terminal and locale, and no text from the network can
// control the terminal.
struct Canvas {
  struct Cell {
    char character = ' ';
    Tone tone = Tone::plain;
  };
  std::array<std::array<Cell, kColumns>, kRows> cells{};

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

// The robot from its left side, nose to the right: body, belts and flippers at their angles and at its pitch. 9 rows
// and 38 columns beginning at (row, column). Front flippers '\', '/' or '-' according to their angle; a pair at
// different angles shows both.
void draw_posture(Canvas& canvas, std::size_t row, std::size_t column, const Status& status);

Canvas draw_screen(const View& view);

// Such as "driving  t 8.10 s  rtt 203 ms  heard 0.04 s ago  lost 5/4 %  tracks 200 200 mm/s  nose up 23.4  flippers 57
// 57 0 0 ...".
// "-" stands for a figure that was not measured.
std::string plain_line(const View& view);

}  // namespace kenaf::teleop
