// SPDX-License-Identifier: BSD-3-Clause
//
// Self-contact among neighbours: quads with a common node, within windows of 2 x 2 quads (or fewer, on a narrower
// grid). A window that is proven flat (narrow_phase/flatness.h) has no candidates.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "contact/broad_phase/box_hierarchy.h"
#include "contact/narrow_phase/element_pairs.h"
#include "contact/narrow_phase/flatness.h"
#include "contact/narrow_phase/separating_axis.h"

namespace curtain {

/// Not thread-safe.
class Windows {
 public:
  /// per_spacing and elements must outlive this.
  Windows(const Grid& grid, const Spacings& per_spacing, const ElementPairs& elements);

  /// Finds the windows of wanted rows that are not proven flat for `reach` [m]. rounding [m]: of a difference of two
  /// coordinates. Allocates nothing.
  void find(const MovingNodes& nodes, const BoxHierarchy& hierarchy, float reach, float rounding) noexcept;

  bool any() const noexcept { return !bent_.empty(); }
  /// Calls vertex(nodes) and edge(nodes) for the element pairs of these windows, except some whose boxes are more than
  /// `reach` [m] apart along an axis. Pairs of quads shared by several windows belong to the first one. Handles share
  /// number `share` of `shares` of the windows. Thread-safe.
  template <typename Vertex, typename Edge>
  void forEachPair(const SweptNodes& swept, float reach, std::size_t share, std::size_t shares, const Vertex& vertex,
                   const Edge& edge) const {
    const std::size_t end = bent_.size() * (share + 1) / shares;
    for (std::size_t k = bent_.size() * share / shares; k < end; ++k) {
      const Window& window = bent_[k];
      if (window.row + 1 == rows_ || window.column + 4 > grid_.columns || isCut(window))
        forEachPairOf(window, vertex, edge);
      else
        forEachNearPairOf(window, swept, reach, vertex, edge);
    }
  }

 private:
  struct Window {
    int row, column;
  };

  /// Four nodes of an element pair within an inner window, numbered row by row (three a row).
  using LocalPair = std::array<std::uint8_t, 4>;

  template <typename Vertex, typename Edge>
  void forEachNearPairOf(const Window& window, const SweptNodes& swept, float reach, const Vertex& vertex,
                         const Edge& edge) const {
    std::array<std::uint32_t, 9> nodes;
    std::array<MovingBox, 9> boxes;
    for (int k = 0; k < 9; ++k) {
      const std::size_t n = grid_.index(window.row + k / 3, window.column + k % 3);
      nodes[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(n);
      boxes[static_cast<std::size_t>(k)] = {swept.start[n].min(swept.end[n]), swept.start[n].max(swept.end[n])};
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
  /// A slit takes a quad of the window away. The last row has the most slits.
  bool isCut(const Window& window) const noexcept {
    if (grid_.slit_row.empty()) return false;
    const int row = window.row + high_ - 1;
    return !grid_.hasQuad(row, window.column + 1) || !grid_.hasQuad(row, window.column + 2);
  }

  Grid grid_;
  const ElementPairs& elements_;
  const Spacings& per_spacing_;
  int high_, wide_;     // quads along a window
  int rows_, columns_;  // number of windows
  std::vector<LocalPair> vertices_, edges_;
  std::vector<Window> bent_;
};

}  // namespace curtain
