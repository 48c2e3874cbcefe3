// Guesses the mapping of a recording, for a person to check.
//
// Thread safety: pure functions.
#pragma once

#include <optional>
#include <string>

#include "gap/recordings/survey.hpp"
#include "physics/robot_description.hpp"

namespace kenaf::gap::recordings {

struct GuessFor {
  std::string recording;                             // as the user names it, for comments
  std::string robot_name;                            // likewise
  const physics::RobotDescription* robot = nullptr;  // gauge and sprocket; null: to be filled in
};

struct Guess {
  std::string toml;          // as parse_mapping() reads it, with why beside each line
  std::size_t entries = 0;   // of columns, drives and poses; 0: nothing was recognised, and the text says so
  std::size_t to_check = 0;  // lines marked CHECK
};

// Guesses by the names of topics, fields and columns, their types, units in their names, and their numbers. Topics that
// are not used are listed at the end, with type, count and why.
Guess guess_mapping(const Survey& survey, const GuessFor& options);

}  // namespace kenaf::gap::recordings
