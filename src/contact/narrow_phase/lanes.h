// SPDX-License-Identifier: BSD-3-Clause
//
// Vectors of four things side by side, in single precision: what every x86-64 has registers for, so the bits do not
// depend on the machine.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace curtain {

using Lanes = float __attribute__((vector_size(16)));

struct LaneVectors {
  Lanes x, y, z;
};

inline Lanes lanesOf(float value) { return Lanes{} + value; }
// By a copy: clang takes a vector behind a pointer for aligned whatever its type says.
inline Lanes loadLanes(const float* from) {
  Lanes value;
  std::memcpy(&value, from, sizeof value);
  return value;
}
inline Lanes lesser(const Lanes& a, const Lanes& b) { return a < b ? a : b; }
inline Lanes greater(const Lanes& a, const Lanes& b) { return a > b ? a : b; }
inline Lanes rootOf(const Lanes& a) { return Lanes{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])}; }
/// Lane k: the least lane of the kth.
inline Lanes leastOfEach(const Lanes& a, const Lanes& b, const Lanes& c, const Lanes& d) {
  const Lanes ab = lesser(__builtin_shufflevector(a, b, 0, 1, 4, 5), __builtin_shufflevector(a, b, 2, 3, 6, 7));
  const Lanes cd = lesser(__builtin_shufflevector(c, d, 0, 1, 4, 5), __builtin_shufflevector(c, d, 2, 3, 6, 7));
  return lesser(__builtin_shufflevector(ab, cd, 0, 2, 4, 6), __builtin_shufflevector(ab, cd, 1, 3, 5, 7));
}
inline float leastLane(const Lanes& a) {
  const float p = a[0] < a[1] ? a[0] : a[1], q = a[2] < a[3] ? a[2] : a[3];
  return p < q ? p : q;
}

inline LaneVectors operator-(const LaneVectors& a, const LaneVectors& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline LaneVectors operator+(const LaneVectors& a, const LaneVectors& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline LaneVectors operator*(const Lanes& s, const LaneVectors& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Lanes dot(const LaneVectors& a, const LaneVectors& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline LaneVectors cross(const LaneVectors& a, const LaneVectors& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace curtain
