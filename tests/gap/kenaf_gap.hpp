// Runs the program kenaf-gap as a user does.
#pragma once

#include <string>

#include "tests/support/outcome.hpp"

namespace kenaf::test {

// In `folder`, with `arguments` as a shell takes them.
inline Outcome kenaf_gap(const TemporaryFolder& folder, const std::string& arguments) {
  return outcome_in(folder, "'" KENAF_GAP "' " + arguments);
}

}  // namespace kenaf::test
