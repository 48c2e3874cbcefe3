// Runs many independent jobs on all cores.
#pragma once

#include <cstddef>
#include <functional>

namespace kenaf::gap {

// Calls job(0) ... job(count - 1), each once, on at most `threads` threads (0: one per core), in unspecified order.
// After a job throws, no further job starts; rethrows the exception of the lowest index.
void for_each_job(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& job);

}  // namespace kenaf::gap
