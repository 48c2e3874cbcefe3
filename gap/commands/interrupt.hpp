// Ctrl-C while something long runs: it shall end by itself, with what it has.
#pragma once

#include <atomic>

namespace kenaf::gap::commands {

// From now on a first SIGINT, SIGTERM or SIGHUP sets this; a second one ends the program at once. Thread safety: call
// it from one.
const std::atomic<bool>& interruption();

}  // namespace kenaf::gap::commands
