// The terminal, by ncurses: shows a Canvas, reads keys by the names of keys.hpp. One per process: ncurses has global
// state.
#pragma once

#include <optional>
#include <string>

#include "screen.hpp"

namespace kenaf::teleop {

class Terminal {
 public:
  Terminal();   // throws std::runtime_error if standard output is no terminal, or one of an unknown type
  ~Terminal();  // restores the terminal
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  // The terminal's present size.
  std::size_t rows() const;
  std::size_t columns() const;
  // Shows as much of it as fits.
  void show(const Canvas& canvas);
  // Returns a pending key without waiting; nullopt: none. Unknown keys are "?", whatever bytes the terminal sends for
  // them.
  std::optional<std::string> key();
};

}  // namespace kenaf::teleop
