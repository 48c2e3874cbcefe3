#include "terminal.hpp"

#include <fmt/format.h>
#include <ncurses.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace kenaf::teleop {

namespace {

constexpr int kEscape_ms = 25;  // later bytes after an escape are not part of a key's sequence
constexpr int kCtrlC = 3, kEscape = 27;

void define_tones() {
  if (!has_colors()) return;
  start_color();
  use_default_colors();
  init_pair(static_cast<short>(Tone::title), COLOR_CYAN, -1);
  init_pair(static_cast<short>(Tone::good), COLOR_GREEN, -1);
  init_pair(static_cast<short>(Tone::warning), COLOR_YELLOW, -1);
  init_pair(static_cast<short>(Tone::alarm), COLOR_RED, -1);
}

// Also readable without colours.
attr_t attributes_of(Tone tone) {
  const attr_t colour = has_colors() ? static_cast<attr_t>(COLOR_PAIR(static_cast<int>(tone))) : 0;
  switch (tone) {
    case Tone::plain:
      return A_NORMAL;
    case Tone::dim:
      return A_DIM;
    case Tone::title:
      return A_BOLD | colour;
    case Tone::good:
      return colour;
    case Tone::warning:
      return A_BOLD | colour;
    case Tone::alarm:
      return A_BOLD | A_REVERSE | colour;
  }
  return A_NORMAL;
}

std::string name_of_key(int key) {
  switch (key) {
    case KEY_UP:
      return "up";
    case KEY_DOWN:
      return "down";
    case KEY_LEFT:
      return "left";
    case KEY_RIGHT:
      return "right";
    case KEY_HOME:
      return "home";
    case KEY_END:
      return "end";
    case KEY_PPAGE:
      return "page_up";
    case KEY_NPAGE:
      return "page_down";
    case ' ':
      return "space";
    case kCtrlC:
      return "ctrl_c";
    default:
      return key > ' ' && key <= '~' ? std::string(1, static_cast<char>(key)) : "?";
  }
}

// After an escape: consumes the rest of a key sequence unknown to terminfo (control-left is "\x1b[1;5D"), whose digits
// would be keys of their own. A key pressed after Esc, or with Alt, is kept: it may be the emergency stop.
void skip_unknown_sequence() {
  const auto is_of_sequence = [](int byte) { return byte >= ' ' && byte <= '~'; };
  int byte = getch();
  if (byte == '[' || byte == 'O') {
    do byte = getch();
    while (is_of_sequence(byte) && (byte < '@' || byte == '['));  // "\x1b[[A" is F1 on Linux' console
    if (is_of_sequence(byte)) return;
  }
  if (byte != ERR) ungetch(byte);
}

}  // namespace

Terminal::Terminal() {
  if (::isatty(STDIN_FILENO) == 0 || ::isatty(STDOUT_FILENO) == 0) {
    throw std::runtime_error("the screen needs a terminal; --plain and --script do without");
  }
  if (newterm(nullptr, stdout, stdin) == nullptr) {
    const char* name = std::getenv("TERM");
    throw std::runtime_error(fmt::format("the terminal '{}' (TERM) is not known here", name == nullptr ? "" : name));
  }
  raw();  // control-S must not stop the console; control-C is a key
  noecho();
  keypad(stdscr, TRUE);
  nodelay(stdscr, TRUE);
  set_escdelay(kEscape_ms);
  curs_set(0);
  define_tones();
}

Terminal::~Terminal() {
  endwin();
}

void Terminal::show(const Canvas& canvas) {
  erase();
  // resized since it was drawn: what fits
  const auto rows = std::min(canvas.rows(), static_cast<std::size_t>(LINES));
  const auto columns = std::min(canvas.columns(), static_cast<std::size_t>(COLS));
  for (std::size_t row = 0; row < rows; ++row) {
    move(static_cast<int>(row), 0);
    for (std::size_t column = 0; column < columns; ++column) {
      const Canvas::Cell& cell = canvas.cells[row][column];
      addch(static_cast<chtype>(cell.character) | static_cast<chtype>(attributes_of(cell.tone)));
    }
  }
  refresh();
}

std::size_t Terminal::rows() const {
  return static_cast<std::size_t>(LINES);
}

std::size_t Terminal::columns() const {
  return static_cast<std::size_t>(COLS);
}

std::optional<std::string> Terminal::key() {
  const int key = getch();
  if (key == ERR) return std::nullopt;
  if (key == kEscape) skip_unknown_sequence();
  return name_of_key(key);
}

}  // namespace kenaf::teleop
