// User-defined effects: a TOML file lists which numbers of a robot's description move together, and how far.
// docs/effects.md lists every key. Thread safety: pure functions.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "formats/description/description_error.hpp"
#include "gap/candidates/candidate.hpp"

namespace kenaf::gap::candidates {

// Returns the effects in the order of the file. set() moves each key relative to the robot's current value, so it adds
// to what other candidates have set. Throws DescriptionError with file, line and column if a key is unknown or missing,
// this robot lacks a number, or an end of a range makes an invalid robot.
std::vector<Candidate> read_own_effects(const std::filesystem::path& file, const physics::RobotDescription& robot);
std::vector<Candidate> parse_own_effects(std::string_view toml, const std::string& name_for_errors,
                                         const physics::RobotDescription& robot);

}  // namespace kenaf::gap::candidates
