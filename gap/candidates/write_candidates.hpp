// A robot's TOML file with what was found. Thread safety: a pure function.
#pragma once

#include <span>
#include <string>
#include <utility>

#include "formats/description/description_error.hpp"
#include "gap/candidates/candidate.hpp"

namespace kenaf::gap::candidates {

// The text of the robot that the candidates make, one after the other, of the robot of `toml_text`, for which they were
// made: parse_robot() of the one gives the bits of the other. What does not change stays as it is written, with all
// comments: numbers are replaced where they stand, a key that was not there is added to its table, effects are added as
// tables at the end. (Only where that cannot be, as with an inline `effects`, is the file written anew, without
// comments.)
//
// Throws DescriptionError where `toml_text` is no robot, or the values together make none.
std::string robot_toml_with(const std::string& toml_text, std::span<const std::pair<Candidate, double>> values);

}  // namespace kenaf::gap::candidates
