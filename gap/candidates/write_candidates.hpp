// Writes fitted values into a robot's TOML file. Thread safety: a pure function.
#pragma once

#include <span>
#include <string>
#include <utility>

#include "formats/description/description_error.hpp"
#include "gap/candidates/candidate.hpp"

namespace kenaf::gap::candidates {

// Returns `toml_text` with the candidates applied in order; they must have been made for its robot. parse_robot() of
// the result equals the robot after set(), bit by bit. All other text and all comments stay: numbers are replaced in
// place, missing keys are added to their table, effects as tables at the end. (Only if that is impossible, as with an
// inline `effects`, the file is rewritten without comments.)
//
// Throws DescriptionError if `toml_text` is not a valid robot, or the values together make an invalid one.
std::string robot_toml_with(const std::string& toml_text, std::span<const std::pair<Candidate, double>> values);

}  // namespace kenaf::gap::candidates
