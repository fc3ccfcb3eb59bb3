// SPDX-License-Identifier: BSD-3-Clause
//
// Bounding volume hierarchy of the cloth: an implicit quadtree over its quads. Level 0 holds the quads, four blocks (2
// x 2) of a level form one block of the next. Each block has the axis-aligned box that its nodes stay in during the
// motion.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "cloth/cloth.h"

namespace curtain {

/// Positions of the nodes at the start and the end of a motion, single precision, relative to an origin that moves
/// with the cloth (so that rounding is small). One array per component: rows of nodes at `stride`; closed cloth
/// repeats its first two columns behind the last. A vector register may be loaded from any node.
struct MovingNodes {
  using Floats = std::vector<float, CacheAligned<float>>;
  std::size_t stride = 0;
  std::array<Floats, 3> start, end;  // [m]
};

/// Axis-aligned box of a motion; the fourth lane is 0.
struct MovingBox {
  Eigen::Array4f low, high;  // [m]

  void merge(const MovingBox& other) noexcept {
    low = low.min(other.low);
    high = high.max(other.high);
  }
  MovingBox merged(const MovingBox& other) const noexcept { return {low.min(other.low), high.max(other.high)}; }
  /// Whether the gap along every axis is at most `reach` [m].
  bool meets(const MovingBox& other, float reach) const noexcept {
    return ((low - other.high).max(other.low - high) <= reach).all();
  }
};

/// Not thread-safe.
class BoxHierarchy {
 public:
  using Floats = MovingNodes::Floats;

  /// Blocks of a level are at first + row * stride + column in every array. Closed cloth repeats three columns on
  /// either side. All other padding holds empty boxes, which overlap nothing.
  struct Level {
    int rows, columns;
    std::size_t first, stride;
    std::size_t at(int i, int j) const noexcept {
      return first + static_cast<std::size_t>(i) * stride + static_cast<std::size_t>(j);
    }
    int rowOf(std::size_t block) const noexcept { return static_cast<int>((block - first) / stride); }
    int columnOf(std::size_t block) const noexcept { return static_cast<int>((block - first) % stride); }
  };
  /// Largest offset in rows or columns of a tested pair (hierarchy_pairs.h).
  static constexpr int kMostOffset = 3;

  explicit BoxHierarchy(const Grid& grid);

  /// Single quads first; the last level has at most four rows and four columns.
  const std::vector<Level>& levels() const noexcept { return levels_; }
  bool closed() const noexcept { return grid_.closed; }

  /// Wanted from now on: pairs with a quad that has a marked node (not 0; of the grid's size); null: all pairs.
  void select(const std::vector<std::uint8_t>* marked) noexcept;
  /// Drops pairs within neighbouring blocks of a level unless both blocks are isBent(row, column).
  template <typename IsBent>
  void excludeFlat(std::size_t level, const IsBent& bent) noexcept {
    const Level& blocks = levels_[level];
    for (int i = 0; i < blocks.rows; ++i) {
      for (int j = 0; j < blocks.columns; ++j) {
        if (!bent(i, j)) excludeWithin(level, i, j);
      }
    }
    selectRows();
  }
  /// Whether any pair of quads of the two blocks is wanted: in general; when the quads are in neighbouring blocks.
  bool isMarked(std::size_t a, std::size_t b) const noexcept { return ((selected_[a] | selected_[b]) & kMarked) != 0; }
  bool isWanted(std::size_t a, std::size_t b) const noexcept { return isWanted(selected_[a], selected_[b]); }
  /// The same for any two blocks of two rows.
  bool areRowsWanted(std::size_t level, int a, int b) const noexcept {
    return isWanted(selected_rows_[level][static_cast<std::size_t>(a)],
                    selected_rows_[level][static_cast<std::size_t>(b)]);
  }

  /// Fits the boxes of a level and those above to what is said of it: low(row, column, axis), high(row, column, axis)
  /// [m].
  template <typename Low, typename High>
  void refitFrom(std::size_t at_level, const Low& low, const High& high) noexcept {
    const Level& level = levels_[at_level];
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      for (int i = 0; i < level.rows; ++i) {
        for (int j = 0; j < level.columns; ++j) {
          lows_[k][level.at(i, j)] = low(i, j, axis);
          highs_[k][level.at(i, j)] = high(i, j, axis);
        }
      }
      wrapAround(level, lows_[k]);
      wrapAround(level, highs_[k]);
    }
    mergeUpwards(at_level + 1, levels_.size());
  }
  /// Refits the levels below it to the motion of the nodes.
  void refitBelow(std::size_t level, const MovingNodes& nodes) noexcept;

  const std::array<Floats, 3>& lows() const noexcept { return lows_; }
  const std::array<Floats, 3>& highs() const noexcept { return highs_; }
  /// Copies the boxes for meet(). Call after refitting.
  void interleaveBoxes() noexcept;
  /// Whether two boxes are at most `reach` [m] apart along every axis.
  bool meet(std::size_t a, std::size_t b, float reach) const noexcept { return boxes_[a].meets(boxes_[b], reach); }

 private:
  void wrapAround(const Level& level, Floats& values) const noexcept;
  void boxesOfQuads(const MovingNodes& nodes) noexcept;
  void mergeUpwards(std::size_t from, std::size_t to) noexcept;
  static constexpr std::uint8_t kMarked = 1, kBent = 2;
  static bool isWanted(std::uint8_t a, std::uint8_t b) noexcept {
    return ((a | b) & kMarked) != 0 && (a & b & kBent) != 0;
  }
  void selectMarked(const std::vector<std::uint8_t>& marked) noexcept;
  void excludeWithin(std::size_t level, int row, int column) noexcept;
  void selectRows() noexcept;

  Grid grid_;
  std::vector<Level> levels_;
  std::array<Floats, 3> lows_, highs_;                    // [m]
  std::vector<MovingBox> boxes_;                          // the same, one box after the other
  std::vector<std::uint8_t> selected_;                    // by block: kMarked, kBent
  std::vector<std::vector<std::uint8_t>> selected_rows_;  // by level and row
};

}  // namespace curtain
