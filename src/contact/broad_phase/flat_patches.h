// SPDX-License-Identifier: BSD-3-Clause
//
// Patches of 4 x 4 quads: the boxes that they stay in during a motion, and which are proven flat. No two elements
// within a flat window of 2 x 2 patches come near each other, so self-contact need not be searched there. Swinging and
// waving cloth is mostly such.
//
// The bound is that of narrow_phase/flatness.h for all triangles of a window, evaluated on the box that holds their
// slopes x_u and x_v at both instants. With u and v rescaled so that the centres U, V of these boxes are unit vectors
// at c = U . V, lambda = min(sqrt(1 + c), sqrt(1 - c)) at the centre. The half edges of the boxes, projected on a and
// b, bound the deviation of J from that.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "contact/broad_phase/swept_nodes.h"
#include "contact/narrow_phase/flatness.h"

namespace curtain {

/// Axis-aligned box of a motion; the fourth lane is 0.
struct MovingBox {
  Eigen::Array4f low, high;  // [m]
  void merge(const MovingBox& other) noexcept {
    low = low.min(other.low);
    high = high.max(other.high);
  }
};

/// Not thread-safe.
class FlatPatches {
 public:
  static constexpr int kAlong = 4;  ///< quads along a patch

  /// grid: of the swept nodes; per_spacing must outlive this.
  FlatPatches(const Grid& grid, const Spacings& per_spacing);

  int rows() const noexcept { return rows_; }
  int columns() const noexcept { return columns_; }
  /// Computes slopes and boxes of a row of patches. Allocates nothing.
  void measureRow(const SweptNodes& nodes, int row) noexcept;
  /// Box of a patch, numbered row by row, over the motion.
  const MovingBox& box(int patch) const noexcept { return boxes_[static_cast<std::size_t>(patch)]; }
  /// Largest magnitude of a coordinate [m].
  float largest() const noexcept;
  /// Finds the windows that are proven to keep elements without a common node further than `reach` [m] apart during the
  /// motion. rounding [m]: largest rounding error of a difference of two coordinates. True: all are. Allocates nothing.
  bool find(float reach, float rounding) noexcept;
  /// Whether a window, by its upper left patch, is flat; at a border it has fewer patches.
  bool isFlat(int first) const noexcept { return flat_[static_cast<std::size_t>(first)] != 0; }
  /// Whether two patches are in one window that is flat.
  bool areFlat(int a, int b) const noexcept {
    const int row_a = a / columns_, row_b = b / columns_, column_a = a % columns_, column_b = b % columns_;
    return std::abs(row_a - row_b) < 2 && std::abs(column_a - column_b) < 2 &&
           isFlat(std::min(row_a, row_b) * columns_ + std::min(column_a, column_b));
  }

 private:
  struct Slopes {
    MovingBox u, v;                            // bounds of the derivatives along weft and warp [1]
    float spacing_u = 0.0f, spacing_v = 0.0f;  // smallest rest spacing of columns and rows [m]
    void merge(const Slopes& other) noexcept {
      u.merge(other.u);
      v.merge(other.v);
      spacing_u = std::min(spacing_u, other.spacing_u);
      spacing_v = std::min(spacing_v, other.spacing_v);
    }
  };

  std::size_t at(int row, int column) const noexcept { return static_cast<std::size_t>(row * columns_ + column); }
  static bool keepsApart(const Slopes& slopes, float reach, float rounding) noexcept;

  Grid grid_;
  int rows_, columns_;  // of patches
  const Spacings& per_spacing_;
  std::array<SweptNodes::Floats, 18>
      ranges_;  // per column of a row of patches: low and high of position, u, v, along x, y, z
  std::vector<MovingBox> boxes_;
  std::vector<Slopes> slopes_;
  std::vector<std::uint8_t> flat_;  // by upper left patch of a window
};

}  // namespace curtain
