// SPDX-License-Identifier: BSD-3-Clause
//
// Blocks of the cloth that are proven flat: no two elements within a window of 2 x 2 blocks come near each other, so
// self-contact need not be searched there. Swinging and waving cloth is mostly such.
//
// The bound is that of narrow_phase/flatness.h for all triangles of a window, evaluated on the box that holds their
// slopes x_u and x_v at both instants. With u and v rescaled so that the centres U, V of these boxes are unit vectors
// at c = U . V, lambda = min(sqrt(1 + c), sqrt(1 - c)) at the centre. The half edges of the boxes, projected on a and
// b, bound the deviation of J from that.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "contact/broad_phase/box_hierarchy.h"
#include "contact/narrow_phase/flatness.h"

namespace curtain {

/// Not thread-safe.
class FlatBlocks {
 public:
  /// level: of the hierarchy's blocks; quads_along: quads along such a block; per_spacing must outlive this.
  FlatBlocks(const Grid& grid, const Spacings& per_spacing, const BoxHierarchy::Level& level, int quads_along);

  /// Computes slopes and boxes of all blocks. Allocates nothing.
  void measure(const MovingNodes& nodes) noexcept;
  /// Bounding box of a block over the motion, along an axis [m].
  float low(int row, int column, int axis) const noexcept { return boxes_[at(row, column)].low[axis]; }
  float high(int row, int column, int axis) const noexcept { return boxes_[at(row, column)].high[axis]; }
  /// Largest magnitude of a coordinate [m].
  float largest() const noexcept;
  /// Marks as bent the blocks of every window that is not proven to keep elements without a common node further than
  /// `reach` [m] apart during the motion. rounding [m]: largest rounding error of a difference of two coordinates.
  /// False: all blocks are proven flat. Allocates nothing.
  bool find(float reach, float rounding) noexcept;
  bool isBent(int row, int column) const noexcept { return bent_[at(row, column)] != 0; }

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
  void measureStrip(const MovingNodes& nodes, int strip) noexcept;
  static bool keepsApart(const Slopes& slopes, float reach, float rounding) noexcept;

  Grid grid_;
  int rows_, columns_, along_;  // blocks; quads along a block
  const Spacings& per_spacing_;
  std::array<MovingNodes::Floats, 18> ranges_;  // per column of a strip: low and high of position, u, v, along x, y, z
  std::vector<MovingBox> boxes_;
  std::vector<Slopes> slopes_;
  std::vector<std::uint8_t> bent_;
};

}  // namespace curtain
