// SPDX-License-Identifier: BSD-3-Clause
//
// Marks a function with loops over nodes to be compiled for AVX2, too, chosen at program start. Without contraction to
// fused multiply-add both versions give the same bits.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define CURTAIN_WIDE __attribute__((target_clones("avx2", "default")))
#define CURTAIN_INTO_WIDE __attribute__((always_inline)) inline
#else
#define CURTAIN_WIDE
#define CURTAIN_INTO_WIDE inline
#endif
