// The terminal, by ncurses: shows a Canvas, reads keys by the names of keys.hpp. One per process: ncurses has a global
// state.
#pragma once

#include <optional>
#include <string>

#include "screen.hpp"

namespace kenaf::teleop {

class Terminal {
 public:
  Terminal();   // throws std::runtime_error where standard output is no terminal, or one that nobody knows
  ~Terminal();  // as it was before
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  // Says so instead where the terminal is smaller than the canvas.
  void show(const Canvas& canvas);
  // A key that came, without waiting; nullopt: none did. Unknown ones are "?", whatever bytes the terminal sends for
  // them.
  std::optional<std::string> key();
};

}  // namespace kenaf::teleop
