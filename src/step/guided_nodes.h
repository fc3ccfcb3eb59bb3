// SPDX-License-Identifier: BSD-3-Clause
//
// Nodes that do not move freely: an impulse p moves one by w F p, where w is the inverse inertia that it would have as
// a free node and F its freedom, a 3 x 3 matrix. On a line with tangent t, F = t t^T; on a surface with normal n, I - n
// n^T; 0: it stays. So the inverse inertia of every node is a matrix: w I free, 0 pinned, w F here.
//
// Loops over all nodes move them as if they were free, by w p. After each of these loops settle() puts them where they
// may be. Where a system of equations is set up the matrix itself is needed.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "cloth/cloth.h"

namespace curtain {

struct GuidedNode {
  std::size_t node = 0;                               ///< in the grid's fields
  Eigen::Matrix3d freedom = Eigen::Matrix3d::Zero();  ///< F, where the links' directions are from
  Eigen::Matrix3d newton = Eigen::Matrix3d::Zero();   ///< what w p moves it by from where it is now
};

class GuidedNodes {
 public:
  virtual ~GuidedNodes() = default;

  /// Some node of this row is guided.
  bool inRow(int row) const noexcept {
    return first_[static_cast<std::size_t>(row)] != first_[static_cast<std::size_t>(row) + 1];
  }
  /// The guided node of a row and a column; null: it is none.
  const GuidedNode* at(int row, int column) const noexcept {
    const int index = index_[static_cast<std::size_t>(row) * stride_ + static_cast<std::size_t>(column)];
    return index < 0 ? nullptr : &nodes_[static_cast<std::size_t>(index)];
  }
  /// Calls act(guided node, column) for those of a row in columns [first, end).
  template <typename Act>
  void forEach(int row, int first, int end, const Act& act) const {
    if (!inRow(row)) return;
    const std::size_t begin = static_cast<std::size_t>(row) * stride_;
    const std::size_t past = begin + static_cast<std::size_t>(end);
    for (auto at = from(begin + static_cast<std::size_t>(first)); at != nodes_.end() && at->node < past; ++at)
      act(*at, static_cast<int>(at->node - begin));
  }
  /// The same of all rows.
  template <typename Act>
  void forEach(int first, int end, const Act& act) const {
    for (const int row : rows_)
      forEach(row, first, end, [&](const GuidedNode& guided, int column) { act(guided, row, column); });
  }

  /// Puts those of columns [first, end) where they may be, by what position has moved them since. Blocks of columns may
  /// do so in parallel.
  virtual void settlePositions(int first, int end, Field3& position) noexcept = 0;
  virtual void settleVelocities(int first, int end, Field3& velocity) noexcept = 0;

 protected:
  /// nodes: sorted.
  GuidedNodes(const Grid& grid, const std::vector<std::size_t>& nodes)
      : stride_(static_cast<std::size_t>(grid.stride)),
        nodes_(nodes.size()),
        index_(nodes.empty() ? 0 : grid.size(), -1) {
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      nodes_[k].node = nodes[k];
      index_[nodes[k]] = static_cast<int>(k);
    }
    for (int row = 0; row <= grid.rows; ++row)
      first_.push_back(static_cast<std::size_t>(from(grid.row(row)) - nodes_.begin()));
    for (int row = 0; row < grid.rows; ++row) {
      if (inRow(row)) rows_.push_back(row);
    }
  }
  /// In the order of the constructor's nodes.
  GuidedNode& guided(std::size_t k) noexcept { return nodes_[k]; }

 private:
  std::vector<GuidedNode>::const_iterator from(std::size_t node) const noexcept {
    return std::lower_bound(nodes_.begin(), nodes_.end(), node,
                            [](const GuidedNode& guided, std::size_t at) { return guided.node < at; });
  }

  std::size_t stride_;
  std::vector<GuidedNode> nodes_;
  std::vector<int> index_;          // by node of the fields; -1: it is free, or pinned
  std::vector<std::size_t> first_;  // of each row, and the end
  std::vector<int> rows_;           // that have some
};

}  // namespace curtain
