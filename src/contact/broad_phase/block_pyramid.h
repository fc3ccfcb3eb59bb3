// SPDX-License-Identifier: BSD-3-Clause
//
// Blocks of quads, from single quads up to a few that make up the whole cloth: four of a level are one of the next. Of every block
// is known the box that its nodes stay in.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "cloth/cloth.h"

namespace curtain {

/// Where nodes are at two instants, relative to some origin and a common motion, in single precision. Component by component: rows of
/// nodes at `stride`, closed cloth has its first two columns once more behind the last; whole vectors may be read from any node.
struct MovingNodes {
  using Floats = std::vector<float, CacheAligned<float>>;
  std::size_t stride = 0;
  std::array<Floats, 3> start, end;  // [m]
};

/// Not thread-safe.
class BlockPyramid {
 public:
  using Floats = MovingNodes::Floats;

  /// Blocks of a level are at first + row * stride + column in every array; closed cloth has its first three columns once more behind
  /// the last, and the last three before the first. All other places before and behind hold boxes that meet none.
  struct Level {
    int rows, columns;
    std::size_t first, stride;
    std::size_t at(int i, int j) const noexcept { return first + static_cast<std::size_t>(i) * stride + static_cast<std::size_t>(j); }
    int rowOf(std::size_t block) const noexcept { return static_cast<int>((block - first) / stride); }
    int columnOf(std::size_t block) const noexcept { return static_cast<int>((block - first) % stride); }
  };
  /// Columns beyond either end that a neighbour may be in.
  static constexpr int kReach = 3;

  explicit BlockPyramid(const Grid& grid);

  /// Single quads first. The last one has at most four rows and four columns.
  const std::vector<Level>& levels() const noexcept { return levels_; }
  bool closed() const noexcept { return grid_.closed; }
  /// Places of the arrays altogether.
  std::size_t size() const noexcept { return lows_[0].size(); }

  /// From now on wanted are the quads with a node that is marked (not 0; of the grid's size), or all.
  void want(const std::vector<std::uint8_t>& marked) noexcept;
  void wantAll() noexcept;
  bool isWanted(std::size_t block) const noexcept { return wanted_[block] != 0; }
  /// Whether any block of a row is.
  bool isRowWanted(std::size_t level, int row) const noexcept { return wanted_rows_[level][static_cast<std::size_t>(row)] != 0; }

  /// Fits the boxes to nodes that move straight from one instant to the other.
  void refit(const MovingNodes& nodes) noexcept;

  const std::array<Floats, 3>& lows() const noexcept { return lows_; }
  const std::array<Floats, 3>& highs() const noexcept { return highs_; }
  /// Whether two boxes are no further apart than `reach` along every axis [m].
  bool meet(std::size_t a, std::size_t b, float reach) const noexcept {
    const Box &p = boxes_[a], &q = boxes_[b];
    return ((p.low - q.high).max(q.low - p.high) <= reach).all();
  }

 private:
  struct Box {
    Eigen::Array4f low, high;  // the fourth lane is 0
  };

  void wrapAround(const Level& level, Floats& values) const noexcept;
  void boxesOfQuads(const MovingNodes& nodes) noexcept;
  void boxesOf(std::size_t level) noexcept;
  void mergeWanted() noexcept;

  Grid grid_;
  std::vector<Level> levels_;
  std::array<Floats, 3> lows_, highs_;  // [m]
  std::vector<Box> boxes_;              // the same, one by one
  std::vector<std::uint8_t> wanted_;                    // of blocks
  std::vector<std::vector<std::uint8_t>> wanted_rows_;  // of levels
};

}  // namespace curtain
