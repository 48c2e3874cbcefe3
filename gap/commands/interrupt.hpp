// Ctrl-C during a long command, which is to end by itself with the results so far.
#pragma once

#include <atomic>

namespace kenaf::gap::commands {

// Returns a flag that a first SIGINT, SIGTERM or SIGHUP sets from now on; a second one ends the program at once. Call
// from one thread only.
const std::atomic<bool>& interruption();

}  // namespace kenaf::gap::commands
