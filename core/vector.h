// Code for processors with wider vectors, chosen when the program starts.
#pragma once

// The sanitizers' start-up does not stand the resolvers that the choice needs.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
/// Before a function: compiled for AVX2 and FMA as well as for any x86-64.
#define STRIAE_VECTORISED __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define STRIAE_VECTORISED
#endif
