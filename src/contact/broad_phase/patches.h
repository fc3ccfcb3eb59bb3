// SPDX-License-Identifier: BSD-3-Clause
//
// Patches of 4 x 4 quads, and the pairs of quads without a common node whose boxes come near each other. Patches are
// swept along one axis, quads of two that meet compared all with all, eight at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include "contact/broad_phase/flat_patches.h"
#include "contact/broad_phase/gaps.h"
#include "contact/broad_phase/swept_nodes.h"

namespace curtain {

/// Numbered row by row. Thread-safe are the const functions.
class Patches {
 public:
  static constexpr int kAlong = FlatPatches::kAlong, kQuads = kAlong * kAlong;  ///< quads along a side, and in all

  /// Quads go by their upper left nodes in this grid; those in gaps are left out.
  Patches(const Grid& grid, const Gaps& gaps);

  /// Takes the boxes of a row of patches' quads during the motion. Allocates nothing. Thread-safe for different rows.
  void fitRow(const SweptNodes& nodes, int row) noexcept;
  /// Takes how far nodes end from where they were expected, for deviate(). Returns a bound of that for any two nodes,
  /// seen from each other [m]. Allocates nothing.
  float measureDeviations(const SweptNodes& nodes) noexcept;

  int rows() const noexcept { return rows_; }
  int columns() const noexcept { return columns_; }
  /// Number of the patch of the quad at (row, column).
  int patchAt(int row, int column) const noexcept { return row / kAlong * columns_ + column / kAlong; }

  /// Takes the boxes of patches and sorts them along the axis along which they extend most; before forEachPair().
  /// Allocates nothing.
  void sort(const FlatPatches& boxes) noexcept;
  /// Calls visit(a, b) for patches whose boxes are at most `reach` [m] apart along every axis, and visit(a, a) for
  /// each: number `share` of `shares` parts of them.
  template <typename Visit>
  void forEachPair(float reach, std::size_t share, std::size_t shares, const Visit& visit) const noexcept {
    for (std::size_t k = share; k < order_.size(); k += shares) {
      const int a = order_[k].second;
      visit(a, a);
      const float end = sorted_[3 + axis_][k] + reach;
      for (std::size_t l = k + 1; l < order_.size() && sorted_[axis_][l] <= end; l += 8) {
        const std::uint32_t all = order_.size() - l < 8 ? (1U << (order_.size() - l)) - 1U : 0xFFU;
        for (std::uint32_t bits = meeting(k, l, reach) & all; bits != 0; bits &= bits - 1)
          visit(a, order_[l + static_cast<std::size_t>(__builtin_ctz(bits))].second);
      }
    }
  }
  /// Calls visit(p, q) for the pairs of a quad of each patch, or of two of the same one, that have no common node and
  /// whose boxes are at most `reach` [m] apart along every axis; after fitRow().
  template <typename Visit>
  void forEachQuadPair(int a, int b, float reach, const Visit& visit) const noexcept {
    std::uint32_t near[kQuads];
    std::uint32_t some = findNear(a, b, reach, near);
    if (some == 0) return;
    const Beside beside = besideOf(a, b);
    for (; some != 0; some &= some - 1) {
      const auto p = static_cast<std::uint32_t>(__builtin_ctz(some));
      std::uint32_t bits = near[p] & ~(beside.rows[p / kAlong] & beside.columns[p % kAlong]);
      if (a == b) bits &= ~((2U << p) - 1U);
      for (; bits != 0; bits &= bits - 1)
        visit(first_[static_cast<std::size_t>(a)] + quad_[p],
              first_[static_cast<std::size_t>(b)] + quad_[static_cast<std::size_t>(__builtin_ctz(bits))]);
    }
  }

  /// After measureDeviations(): whether a node of one patch and one of the other may end further than `most` [m] from
  /// where they were expected, seen from each other. Patches are taken with the quads next to them on the right and
  /// below.
  bool deviate(int a, int b, float most) const noexcept {
    const Eigen::Array4f &p = deviations_[static_cast<std::size_t>(a)], &q = deviations_[static_cast<std::size_t>(b)];
    const float rest = most - p[3] - q[3];
    return !(rest > 0.0f && (p - q).head<3>().square().sum() < rest * rest);
  }

 private:
  /// Of the quads along each axis, and of the patch [m].
  struct Boxes {
    float low[3][kQuads], high[3][kQuads];
    float least[3], most[3];
  };
  /// Bits of quads of a patch in rows and columns next to (or the same as) each row and column of another.
  struct Beside {
    std::uint32_t rows[kAlong], columns[kAlong];
  };
  void rangeOfColumns(const SweptNodes& nodes, std::size_t axis, int row) noexcept;
  Beside besideOf(int a, int b) const noexcept;
  std::uint32_t findNear(int a, int b, float reach, std::uint32_t (&near)[kQuads]) const noexcept;
  std::uint32_t meeting(std::size_t k, std::size_t first, float reach) const noexcept;

  Grid grid_;
  int rows_, columns_;                      // of patches
  std::vector<std::uint32_t> first_;        // by patch: of its first quad
  std::array<std::uint32_t, kQuads> quad_;  // by quad of a patch: seen from the first
  std::vector<std::uint32_t> there_;        // by patch: bits of the quads that it has, whatever the boxes of others
  std::vector<Boxes> boxes_;
  std::vector<Eigen::Array4f> deviations_;  // their centre, and how far they are from it at most [m]
  SweptNodes::Floats lows_, highs_;         // of deviations, by column [m]
  std::size_t axis_ = 0;
  std::vector<std::pair<float, int>> order_;  // low end along the axis, and patch
  std::array<SweptNodes::Floats, 6> sorted_;  // low and high of the boxes along each axis, in this order
};

}  // namespace curtain
