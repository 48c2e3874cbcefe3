// The console's screen as characters, and its one line for --plain: pure functions of what is known. The terminal that
// shows it is terminal.hpp.
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

// 24 lines of 80 characters, printable ASCII only: no terminal and no locale is asked for more, and nothing that came
// by the network can steer the terminal.
struct Canvas {
  struct Cell {
    char character = ' ';
    Tone tone = Tone::plain;
  };
  std::array<std::array<Cell, kColumns>, kRows> cells{};

  // What does not fit is cut; what is not printable becomes '?'.
  void put(std::size_t row, std::size_t column, std::string_view text, Tone tone = Tone::plain);
  std::string line(std::size_t row) const;
};

struct View {
  std::string_view control;                 // address of the control process
  std::string_view camera;                  // where its pictures are; "" = nowhere
  std::string_view gamepad;                 // name; "" = none
  const Status* status = nullptr;           // the newest; null before the first
  std::optional<std::string_view> taken{};  // the robot is another console's: whose
  const LinkHealth& health;
  const Desk& desk;
  const Wish& wish;  // as it is sent now
  double now_s;
};

// The robot from its left side, nose to the right: body, belts and flippers at their angles and at its pitch. 9 rows
// and 38 columns beginning at (row, column). Front flippers '\', '/' or '-' as they lie; a pair that differs shows
// both.
void draw_posture(Canvas& canvas, std::size_t row, std::size_t column, const Status& status);

Canvas draw_screen(const View& view);

// Such as "driving  t 8.10 s  rtt 203 ms  heard 0.04 s ago  lost 5/4 %  tracks 200 200 mm/s  nose up 23.4  flippers 57
// 57 0 0 ...".
// "-" stands for a figure that was not measured.
std::string plain_line(const View& view);

}  // namespace kenaf::teleop
