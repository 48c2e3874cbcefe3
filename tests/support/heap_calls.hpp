// Counts what a thread asks of the heap: C++'s and every library's allocations end in C's functions, and a program that
// is built with heap_calls.cpp has those that count before the C library's. It can also have one of them fail, as if
// memory were out. Not with sanitizers, which do the same.
#pragma once

namespace kenaf::test {

long heap_calls();  // of this thread so far

// The `n`-th call of this thread from now on finds no memory, counted from 1; 0: none. Those after it do find some.
void fail_heap_call(long n);
bool heap_call_failed();  // since fail_heap_call()

}  // namespace kenaf::test
