// Counts operator new in the threads that are looked at: those of the relay, not those of the test around it.
#pragma once

#include <cstdint>

namespace kenaf::test {

extern thread_local bool allocations_of_this_thread_count;  // true unless a thread says otherwise
std::uint64_t allocations();                                // so far

}  // namespace kenaf::test
