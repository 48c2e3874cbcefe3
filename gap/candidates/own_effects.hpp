// Effects of one's own: a TOML file says which numbers of a robot's description move together, and how far.
// docs/own-effects.md lists every key. Thread safety: pure functions.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "formats/description/description_error.hpp"
#include "gap/candidates/candidate.hpp"

namespace kenaf::gap::candidates {

// In the order of the file. set() moves each key from where the robot has it, so what other candidates have set before
// is moved along. Throws DescriptionError with file, line and column where the file is wrong: a key that is unknown or
// missing, a number that this robot does not have, a range at an end of which it would be no robot.
std::vector<Candidate> read_own_effects(const std::filesystem::path& file, const physics::RobotDescription& robot);
std::vector<Candidate> parse_own_effects(std::string_view toml, const std::string& name_for_errors,
                                         const physics::RobotDescription& robot);

}  // namespace kenaf::gap::candidates
