// The page's scripts, as text of its one file: each also is a file beside this one.
//
// Thread safety: constants.
#pragma once

#include <string_view>

namespace kenaf::gap::diagnose {

std::string_view moment_player_script();
std::string_view confusability_script();

}  // namespace kenaf::gap::diagnose
