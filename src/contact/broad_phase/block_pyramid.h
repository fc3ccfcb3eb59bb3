// SPDX-License-Identifier: BSD-3-Clause
//
// Blocks of quads, from single quads up to a few that make up the whole cloth: four of a level are one of the next. Of
// every block is known the box that its nodes stay in.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "cloth/cloth.h"

namespace curtain {

/// Where nodes are at two instants, relative to some origin and a common motion, in single precision. Component by
/// component: rows of nodes at `stride`, closed cloth has its first two columns once more behind the last; whole
/// vectors may be read from any node.
struct MovingNodes {
  using Floats = std::vector<float, CacheAligned<float>>;
  std::size_t stride = 0;
  std::array<Floats, 3> start, end;  // [m]
};

/// Axis-aligned; the fourth lane is 0.
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
class BlockPyramid {
 public:
  using Floats = MovingNodes::Floats;

  /// Blocks of a level are at first + row * stride + column in every array; closed cloth has its first three columns
  /// once more behind the last, and the last three before the first. All other places before and behind hold boxes that
  /// meet none.
  struct Level {
    int rows, columns;
    std::size_t first, stride;
    std::size_t at(int i, int j) const noexcept {
      return first + static_cast<std::size_t>(i) * stride + static_cast<std::size_t>(j);
    }
    int rowOf(std::size_t block) const noexcept { return static_cast<int>((block - first) / stride); }
    int columnOf(std::size_t block) const noexcept { return static_cast<int>((block - first) % stride); }
  };
  /// Columns beyond either end that a neighbour may be in.
  static constexpr int kReach = 3;

  explicit BlockPyramid(const Grid& grid);

  /// Single quads first. The last one has at most four rows and four columns.
  const std::vector<Level>& levels() const noexcept { return levels_; }
  bool closed() const noexcept { return grid_.closed; }

  /// From now on pairs are asked for that have a quad with a node which is marked (not 0; of the grid's size); null:
  /// all.
  void select(const std::vector<std::uint8_t>* marked) noexcept;
  /// And of those within blocks of a level that touch, only where both blocks are uneven(row, column).
  template <typename Uneven>
  void leaveOut(std::size_t level, const Uneven& uneven) noexcept {
    const Level& even = levels_[level];
    for (int i = 0; i < even.rows; ++i) {
      for (int j = 0; j < even.columns; ++j) {
        if (!uneven(i, j)) leaveOutWithin(level, i, j);
      }
    }
    selectRows();
  }
  /// Of two blocks: whether any pair of their quads is asked for, wherever these are; whether it is if they are in
  /// blocks that touch.
  bool isMarked(std::size_t a, std::size_t b) const noexcept { return ((selected_[a] | selected_[b]) & kMarked) != 0; }
  bool isAsked(std::size_t a, std::size_t b) const noexcept { return isAsked(selected_[a], selected_[b]); }
  /// The same of any two blocks of two rows.
  bool areRowsAsked(std::size_t level, int a, int b) const noexcept {
    return isAsked(selected_rows_[level][static_cast<std::size_t>(a)],
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
  /// And those below it to nodes that move straight from one instant to the other.
  void refitBelow(std::size_t level, const MovingNodes& nodes) noexcept;

  const std::array<Floats, 3>& lows() const noexcept { return lows_; }
  const std::array<Floats, 3>& highs() const noexcept { return highs_; }
  /// After the last of these and before meet().
  void fillOneByOne() noexcept;
  /// Whether two boxes are no further apart than `reach` along every axis [m].
  bool meet(std::size_t a, std::size_t b, float reach) const noexcept { return boxes_[a].meets(boxes_[b], reach); }

 private:
  void wrapAround(const Level& level, Floats& values) const noexcept;
  void boxesOfQuads(const MovingNodes& nodes) noexcept;
  void mergeUpwards(std::size_t from, std::size_t to) noexcept;
  static constexpr std::uint8_t kMarked = 1, kUneven = 2;
  static bool isAsked(std::uint8_t a, std::uint8_t b) noexcept {
    return ((a | b) & kMarked) != 0 && (a & b & kUneven) != 0;
  }
  void selectMarked(const std::vector<std::uint8_t>& marked) noexcept;
  void leaveOutWithin(std::size_t level, int row, int column) noexcept;
  void selectRows() noexcept;

  Grid grid_;
  std::vector<Level> levels_;
  std::array<Floats, 3> lows_, highs_;                    // [m]
  std::vector<MovingBox> boxes_;                          // the same, one by one
  std::vector<std::uint8_t> selected_;                    // of blocks
  std::vector<std::vector<std::uint8_t>> selected_rows_;  // of levels
};

}  // namespace curtain
