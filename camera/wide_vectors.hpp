// Compiles a function, with all that it calls inlined, for AVX2 as well: the loader takes what the processor has.
// Without contraction of products and sums (-ffp-contract=off) both give the same bits.
//
// Only where the linker and the sanitizers know functions that the loader chooses (GCC and glibc).
#pragma once

#include <cstdlib>  // defines __GLIBC__

#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define KENAF_WIDE_VECTORS __attribute__((target_clones("avx2", "default"), flatten))
#else
#define KENAF_WIDE_VECTORS
#endif
