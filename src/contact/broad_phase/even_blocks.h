// SPDX-License-Identifier: BSD-3-Clause
//
// Where the cloth is so even that no two parts within windows of 2 x 2 large blocks come near each other: the bound of
// narrow_phase/flatness.h for all triangles of a window, from the box that holds their slopes. What happens within such
// windows need not be looked at, which is all there is of cloth that swings or waves.
//
// Slopes are known by the box that holds x_u and x_v at both instants. With u and v rescaled so that the boxes' centres
// U, V are unit vectors at c = U . V, lambda = min(sqrt(1 + c), sqrt(1 - c)) at the centre, and the boxes' half edges,
// seen along a and b, bound what J may differ from that.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "contact/broad_phase/block_pyramid.h"
#include "contact/narrow_phase/flatness.h"

namespace curtain {

/// Not thread-safe.
class EvenBlocks {
 public:
  /// level: of the pyramid's blocks; quads_along: of one either way. per_spacing must outlive this.
  EvenBlocks(const Grid& grid, const Spacings& per_spacing, const BlockPyramid::Level& level, int quads_along);

  /// Takes slopes and boxes of all blocks. Allocates nothing.
  void measure(const MovingNodes& nodes) noexcept;
  /// The box that a block stays in, along an axis [m].
  float low(int row, int column, int axis) const noexcept { return boxes_[at(row, column)].low[axis]; }
  float high(int row, int column, int axis) const noexcept { return boxes_[at(row, column)].high[axis]; }
  /// The largest magnitude of a coordinate [m].
  float largest() const noexcept;
  /// Finds the blocks that are in a window in which two elements that share no node may be no further apart than
  /// `reach` [m] while nodes move straight; rounding [m]: most by which a difference of two coordinates was rounded.
  /// Allocates nothing. False: there are none.
  bool find(float reach, float rounding) noexcept;
  bool isUneven(int row, int column) const noexcept { return uneven_[at(row, column)] != 0; }

 private:
  struct Slopes {
    MovingBox u, v;                            // of the derivatives along weft and warp [1]
    float spacing_u = 0.0f, spacing_v = 0.0f;  // least reference spacing of the columns and rows [m]
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
  int rows_, columns_, along_;  // of blocks; quads of one either way
  const Spacings& per_spacing_;
  std::array<MovingNodes::Floats, 18>
      ranges_;  // of a strip's columns: low and high of the box, of u, of v along x, y, z
  std::vector<MovingBox> boxes_;
  std::vector<Slopes> slopes_;
  std::vector<std::uint8_t> uneven_;
};

}  // namespace curtain
