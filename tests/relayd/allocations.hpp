// Counts operator new in the threads that are looked at: those of the relay, not those of the test around it.
#pragma once

#include <cstdint>

namespace kenaf::test {

void leave_this_thread_out();  // from now on
std::uint64_t allocations();   // so far

}  // namespace kenaf::test
