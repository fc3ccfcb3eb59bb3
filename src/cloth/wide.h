// SPDX-License-Identifier: BSD-3-Clause
//
// Marks a function whose loops over nodes are worth wider registers: compiled once more for AVX2, chosen when the
// program starts. No contraction to fused multiply-add anywhere, so both give the same bits.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define CURTAIN_WIDE __attribute__((target_clones("avx2", "default")))
#define CURTAIN_INTO_WIDE __attribute__((always_inline)) inline
#else
#define CURTAIN_WIDE
#define CURTAIN_INTO_WIDE inline
#endif
