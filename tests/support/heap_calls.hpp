// Counts what a thread asks of the heap: C++'s and every library's allocations end in C's functions, and a program that
// is built with heap_calls.cpp has those that count before the C library's. Not with sanitizers, which do the same.
#pragma once

namespace kenaf::test {

long heap_calls();  // of this thread so far

}  // namespace kenaf::test
