// SPDX-License-Identifier: BSD-3-Clause
//
// Neighbours: quads that have a node in common, in windows of 2 x 2 quads (or fewer, where there are no more). A window
// that is even enough (narrow_phase/flatness.h) keeps its elements apart.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "contact/broad_phase/block_pyramid.h"
#include "contact/narrow_phase/element_pairs.h"
#include "contact/narrow_phase/flatness.h"
#include "contact/narrow_phase/staying_apart.h"

namespace curtain {

/// Not thread-safe.
class Windows {
 public:
  /// per_spacing and elements must outlive this.
  Windows(const Grid& grid, const Spacings& per_spacing, const ElementPairs& elements);

  /// Finds the windows, of rows that are asked for, that are not even enough to keep `reach` [m]. rounding [m]: of a
  /// difference of two coordinates. Allocates nothing.
  void find(const MovingNodes& nodes, const BlockPyramid& pyramid, float reach, float rounding) noexcept;

  bool any() const noexcept { return !bent_.empty(); }
  /// Calls vertex(nodes) and edge(nodes) for the pairs of elements of those, but for some whose boxes are further apart
  /// than `reach` [m] along an axis. Of the quads that several windows hold, the first one has them. Of one of equal
  /// shares of the windows: number `share` of `shares`. Thread-safe.
  template <typename Vertex, typename Edge>
  void forEachPair(const NodeWays& ways, float reach, std::size_t share, std::size_t shares, const Vertex& vertex,
                   const Edge& edge) const {
    const std::size_t end = bent_.size() * (share + 1) / shares;
    for (std::size_t k = bent_.size() * share / shares; k < end; ++k) {
      const Window& window = bent_[k];
      if (window.row + 1 == rows_ || window.column + 4 > grid_.columns)
        forEachPairOf(window, vertex, edge);
      else
        forEachNearPairOf(window, ways, reach, vertex, edge);
    }
  }

 private:
  struct Window {
    int row, column;
  };

  /// Two elements of a window that is neither in the last row nor column: their nodes, row by row of three.
  using LocalPair = std::array<std::uint8_t, 4>;

  template <typename Vertex, typename Edge>
  void forEachNearPairOf(const Window& window, const NodeWays& ways, float reach, const Vertex& vertex,
                         const Edge& edge) const {
    std::array<std::uint32_t, 9> nodes;
    std::array<MovingBox, 9> boxes;
    for (int k = 0; k < 9; ++k) {
      const std::size_t n = grid_.index(window.row + k / 3, window.column + k % 3);
      nodes[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(n);
      boxes[static_cast<std::size_t>(k)] = {ways.start[n].min(ways.end[n]), ways.start[n].max(ways.end[n])};
    }
    const auto take = [&](const LocalPair& pair, const auto& taker) {
      const FourNodes four{nodes[pair[0]], nodes[pair[1]], nodes[pair[2]], nodes[pair[3]]};
      if (elements_.canMove(four)) taker(four);
    };
    for (const LocalPair& pair : vertices_) {
      if (boxes[pair[0]].meets(boxes[pair[1]].merged(boxes[pair[2]]).merged(boxes[pair[3]]), reach)) take(pair, vertex);
    }
    for (const LocalPair& pair : edges_) {
      if (boxes[pair[0]].merged(boxes[pair[1]]).meets(boxes[pair[2]].merged(boxes[pair[3]]), reach)) take(pair, edge);
    }
  }

  template <typename Vertex, typename Edge>
  void forEachPairOf(const Window& window, const Vertex& vertex, const Edge& edge) const {
    const bool last_row = window.row + 1 == rows_, last_column = !grid_.closed && window.column + 1 == columns_;
    for (int p = 0; p < high_ * wide_; ++p) {
      for (int q = p; q < high_ * wide_; ++q) {
        if ((p / wide_ > 0 && !last_row) || (std::min(p % wide_, q % wide_) > 0 && !last_column)) continue;
        const auto around = [&](int k) { return (window.column + k) % grid_.linkCount(); };
        elements_.forEach(window.row + p / wide_, around(p % wide_), window.row + q / wide_, around(q % wide_), vertex,
                          edge);
      }
    }
  }
  void makeLocalPairs();

  Grid grid_;
  const ElementPairs& elements_;
  const Spacings& per_spacing_;
  int high_, wide_;     // quads of a window
  int rows_, columns_;  // of windows
  std::vector<LocalPair> vertices_, edges_;
  std::vector<Window> bent_;
};

}  // namespace curtain
