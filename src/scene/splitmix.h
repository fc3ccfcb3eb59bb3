// SPDX-License-Identifier: BSD-3-Clause
//
// Random numbers from a key instead of from a state: the same key gives the same number, in whatever order and on
// whichever thread they are asked for.
#pragma once

#include <cstdint>

namespace curtain {

/// Finaliser of splitmix64 (Steele, Lea, Flood 2014).
inline std::uint64_t splitmix(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15ULL;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

}  // namespace curtain
