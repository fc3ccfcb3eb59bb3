// SPDX-License-Identifier: BSD-3-Clause
//
// Eight single-precision lanes, for functions that are also compiled for wider registers (cloth/wide.h). Results are
// written to references: the ABI for returning vectors wider than the baseline's registers is unsettled.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "cloth/shuffle.h"
#include "cloth/wide.h"

namespace curtain {

struct Simd8 {
  static constexpr std::size_t kCount = 8;
  using Lanes = float __attribute__((vector_size(kCount * sizeof(float))));

  struct Vectors {
    Lanes x, y, z;
    CURTAIN_INTO_WIDE void add(const Vectors& other) {
      x += other.x;
      y += other.y;
      z += other.z;
    }
    CURTAIN_INTO_WIDE void subtract(const Vectors& other) {
      x -= other.x;
      y -= other.y;
      z -= other.z;
    }
    CURTAIN_INTO_WIDE void scale(const Lanes& by) {
      x *= by;
      y *= by;
      z *= by;
    }
    CURTAIN_INTO_WIDE void subtract(const Lanes& by, const Vectors& other) {
      x -= by * other.x;
      y -= by * other.y;
      z -= by * other.z;
    }
  };

  static CURTAIN_INTO_WIDE void load(const float* from, Lanes& to) { std::memcpy(&to, from, sizeof to); }
  static CURTAIN_INTO_WIDE void dot(const Vectors& a, const Vectors& b, Lanes& to) {
    to = a.x * b.x + a.y * b.y + a.z * b.z;
  }
  static CURTAIN_INTO_WIDE void cross(const Vectors& a, const Vectors& b, Vectors& to) {
    to.x = a.y * b.z - a.z * b.y;
    to.y = a.z * b.x - a.x * b.z;
    to.z = a.x * b.y - a.y * b.x;
  }
  static CURTAIN_INTO_WIDE void difference(const Vectors& a, const Vectors& b, Vectors& to) {
    to.x = a.x - b.x;
    to.y = a.y - b.y;
    to.z = a.z - b.z;
  }
  static CURTAIN_INTO_WIDE void store(const Lanes& from, float* to) { std::memcpy(to, &from, sizeof from); }
  static CURTAIN_INTO_WIDE void lower(Lanes& least, const Lanes& value) { least = value < least ? value : least; }
  static CURTAIN_INTO_WIDE void raise(Lanes& most, const Lanes& value) { most = value > most ? value : most; }
  /// Where `truth`, `chosen` becomes `other`.
  template <typename Truth>
  static CURTAIN_INTO_WIDE void choose(const Truth& truth, const Vectors& other, Vectors& chosen) {
    chosen.x = truth ? other.x : chosen.x;
    chosen.y = truth ? other.y : chosen.y;
    chosen.z = truth ? other.z : chosen.z;
  }
  /// Each of the first `count` values becomes the least (or most) of itself and the next three, of those there are.
  /// There is room for sixteen more.
  static CURTAIN_INTO_WIDE void reduceFours(float* values, std::size_t count, bool least) {
    for (std::size_t j = count; j < count + 3; ++j) values[j] = values[count - 1];
    for (const std::size_t ahead : {std::size_t{1}, std::size_t{2}}) {
      for (std::size_t j = 0; j < count; j += kCount) {
        Lanes value, other;
        load(values + j, value);
        load(values + j + ahead, other);
        if (least)
          lower(value, other);
        else
          raise(value, other);
        store(value, values + j);
      }
    }
  }
  static CURTAIN_INTO_WIDE void cut(Lanes& value) {
    value = value > 0.0f ? value : Lanes{};
    value = value < 1.0f ? value : Lanes{} + 1.0f;
  }
  static CURTAIN_INTO_WIDE void inverseRoot(const Lanes& of, Lanes& to) {
    float values[kCount];
    std::memcpy(values, &of, sizeof of);
#pragma omp simd
    for (std::size_t k = 0; k < kCount; ++k) values[k] = 1.0f / std::sqrt(values[k]);
    std::memcpy(&to, values, sizeof to);
  }
  /// Eight vectors, the k-th from the four floats at place_of(k); component by component.
  template <typename PlaceOf>
  static CURTAIN_INTO_WIDE void gather(const PlaceOf& place_of, Vectors& to) {
    using Quarter = float __attribute__((vector_size(16)));
    Quarter q[kCount];
    for (std::size_t k = 0; k < kCount; ++k) std::memcpy(&q[k], place_of(k), sizeof q[k]);
    // Nodes k and k + 4 side by side, and then components across.
    Lanes a, b, c, d;
    join(q[0], q[4], a);
    join(q[1], q[5], b);
    join(q[2], q[6], c);
    join(q[3], q[7], d);
    Lanes ab, cd, ab_z, cd_z;
    shuffle<0, 8, 1, 9, 4, 12, 5, 13>(a, b, ab);
    shuffle<0, 8, 1, 9, 4, 12, 5, 13>(c, d, cd);
    shuffle<2, 10, 3, 11, 6, 14, 7, 15>(a, b, ab_z);
    shuffle<2, 10, 3, 11, 6, 14, 7, 15>(c, d, cd_z);
    shuffle<0, 1, 8, 9, 4, 5, 12, 13>(ab, cd, to.x);
    shuffle<2, 3, 10, 11, 6, 7, 14, 15>(ab, cd, to.y);
    shuffle<0, 1, 8, 9, 4, 5, 12, 13>(ab_z, cd_z, to.z);
  }
  /// Bit k: lane k is true (its sign bit).
  template <typename Truth>
  static CURTAIN_INTO_WIDE std::uint32_t bitsOf(const Truth& truth) {
#ifdef __SSE2__
    __m128 halves[2];
    static_assert(sizeof truth == sizeof halves);
    std::memcpy(halves, &truth, sizeof truth);
    return static_cast<std::uint32_t>(_mm_movemask_ps(halves[0]) | _mm_movemask_ps(halves[1]) << 4);
#else
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < kCount; ++k) bits |= (truth[k] != 0 ? 1U : 0U) << k;
    return bits;
#endif
  }
};

}  // namespace curtain
