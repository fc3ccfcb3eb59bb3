// SPDX-License-Identifier: BSD-3-Clause
//
// Neighbours: quads that have a node in common, in windows of 2 x 2 quads (or fewer, where there are no more). A window that is even enough
// (narrow_phase/flatness.h) keeps its elements apart.
#pragma once

#include <cstdint>
#include <vector>

#include "contact/broad_phase/block_pyramid.h"
#include "contact/narrow_phase/element_pairs.h"
#include "contact/narrow_phase/staying_apart.h"

namespace curtain {

/// Not thread-safe.
class Windows {
 public:
  /// elements must outlive this.
  Windows(const ClothPattern& pattern, const ElementPairs& elements);

  /// Finds the windows, of rows that are asked for, that are not even enough to keep `reach` [m]. rounding [m]: of a difference of two
  /// coordinates. Allocates nothing.
  void find(const MovingNodes& nodes, const BlockPyramid& pyramid, float reach, float rounding) noexcept;

  bool any() const noexcept { return !bent_.empty(); }
  /// Calls vertex(nodes) and edge(nodes) for the pairs of elements of those. Of the quads that several windows hold, the first one has them.
  template <typename Vertex, typename Edge>
  void forEachPair(const Vertex& vertex, const Edge& edge) const {
    for (const Window& window : bent_) {
      if (window.row + 1 == rows_ || window.column + 4 > grid_.columns) {
        forEachPairOf(window, vertex, edge);
        continue;
      }
      const auto first = static_cast<std::uint32_t>(grid_.index(window.row, window.column));
      const auto forEach = [&](const std::vector<FourNodes>& offsets, const auto& take) {
        for (const FourNodes& offset : offsets) {
          const FourNodes nodes{first + offset[0], first + offset[1], first + offset[2], first + offset[3]};
          if (elements_.canMove(nodes)) take(nodes);
        }
      };
      forEach(vertex_offsets_, vertex);
      forEach(edge_offsets_, edge);
    }
  }

 private:
  struct Window {
    int row, column;
  };

  template <typename Vertex, typename Edge>
  void forEachPairOf(const Window& window, const Vertex& vertex, const Edge& edge) const {
    const bool last_row = window.row + 1 == rows_, last_column = !grid_.closed && window.column + 1 == columns_;
    for (int p = 0; p < high_ * wide_; ++p) {
      for (int q = p; q < high_ * wide_; ++q) {
        if ((p / wide_ > 0 && !last_row) || (std::min(p % wide_, q % wide_) > 0 && !last_column)) continue;
        const auto around = [&](int k) { return (window.column + k) % grid_.linkCount(); };
        elements_.forEach(window.row + p / wide_, around(p % wide_), window.row + q / wide_, around(q % wide_), vertex, edge);
      }
    }
  }
  void makeOffsets();

  Grid grid_;
  const ElementPairs& elements_;
  int high_, wide_;     // quads of a window
  int rows_, columns_;  // of windows
  BlockPyramid::Floats per_spacing_u_, per_spacing_v_;      // [1/m] of columns, of rows of quads
  std::vector<FourNodes> vertex_offsets_, edge_offsets_;  // from the first node of a window that is neither in the last row nor column
  std::vector<Window> bent_;
};

}  // namespace curtain
