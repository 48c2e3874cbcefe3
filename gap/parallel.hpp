// Many independent jobs on all cores.
#pragma once

#include <cstddef>
#include <functional>

namespace kenaf::gap {

// Calls job(0) ... job(count - 1), each once, on at most `threads` threads (0: one a core), in no given order. After
// a job throws, no further one starts; of what was thrown, that of the lowest index is thrown on.
void for_each_job(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& job);

}  // namespace kenaf::gap
