// SPDX-License-Identifier: BSD-3-Clause
//
// Lanes of two short vectors (GNU's vector_size) put in a new order. clang and g++ from 12 on have a builtin for that;
// g++ before has another, which makes more instructions of it. Only this file knows. Results are written to references:
// the ABI for returning vectors wider than the baseline's registers is unsettled.
#pragma once

#include <cstddef>

#include "cloth/wide.h"

#if defined(__clang__) || __GNUC__ >= 12
#define CURTAIN_HAS_SHUFFLEVECTOR 1
#else
#define CURTAIN_HAS_SHUFFLEVECTOR 0
#endif

namespace curtain {

/// Numbers of lanes, as many as fit into a vector of these bytes.
template <std::size_t bytes>
struct LaneOrder;
template <>
struct LaneOrder<16> {
  using Type = int __attribute__((vector_size(16)));
};
template <>
struct LaneOrder<32> {
  using Type = int __attribute__((vector_size(32)));
};

/// Lane k of the result is lane order[k] of a followed by b. As many places as a has lanes, four bytes each.
template <int... order, typename Lanes>
CURTAIN_INTO_WIDE void shuffle(const Lanes& a, const Lanes& b, Lanes& to) {
#if CURTAIN_HAS_SHUFFLEVECTOR
  to = __builtin_shufflevector(a, b, order...);
#else
  to = __builtin_shuffle(a, b, typename LaneOrder<sizeof(Lanes)>::Type{order...});
#endif
}

/// The four lanes of low, and behind them those of high.
template <typename Quarter, typename Lanes>
CURTAIN_INTO_WIDE void join(const Quarter& low, const Quarter& high, Lanes& to) {
  static_assert(sizeof(Quarter) == 16 && sizeof(Lanes) == 32, "four lanes each");
#if CURTAIN_HAS_SHUFFLEVECTOR
  to = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
#else
  // As pairs of lanes: g++ makes one instruction of that, but eight of the lanes one by one.
  using Pairs = double __attribute__((vector_size(16)));
  const Pairs l = reinterpret_cast<Pairs>(low), h = reinterpret_cast<Pairs>(high);
  const double __attribute__((vector_size(32))) pairs = {l[0], l[1], h[0], h[1]};
  to = reinterpret_cast<Lanes>(pairs);
#endif
}

}  // namespace curtain
