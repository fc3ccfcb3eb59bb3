// SPDX-License-Identifier: BSD-3-Clause
//
// Static tree of axis-aligned boxes over the boxes of any items: which of them may touch a given box. Built once by
// halving along the longest side, so its depth is log2(item count) and a fixed stack is enough; nodes lie in one
// array, siblings side by side. Whoever keeps the items in the order of the leaves reads them in runs.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

class BoxTree {
 public:
  BoxTree() = default;
  /// Finite boxes, fewer than 2^32; none is allowed. O(n log n). The same boxes give the same tree everywhere.
  explicit BoxTree(const std::vector<Eigen::AlignedBox3d>& boxes);

  /// Item (index into the boxes given) in each place of the leaves.
  const std::vector<std::uint32_t>& order() const { return order_; }

  /// Calls visit(first, last) for runs [first, last) of places that hold every item whose box touches `box` (and a few
  /// whose box does not); each place comes at most once. A box that is empty or NaN gets none. Allocates nothing.
  template <typename Visit>
  void forEachRunIn(const Eigen::AlignedBox3d& box, Visit&& visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, kStackSize> stack;
    std::size_t size = 0;
    stack[size++] = 0;
    while (size > 0) {
      const Node& node = nodes_[stack[--size]];
      const bool touches =
          (node.low.array() <= box.max().array()).all() && (node.high.array() >= box.min().array()).all();
      if (!touches) continue;
      if (node.count > 0) {
        visit(node.first, node.first + node.count);
        continue;
      }
      stack[size++] = node.first + 1;
      stack[size++] = node.first;
    }
  }

 private:
  /// Depth is at most 32 (halving of a 32-bit count) and each level leaves one sibling behind.
  static constexpr std::size_t kStackSize = 64;

  struct Node {
    Vec3 low;
    Vec3 high;
    std::uint32_t first;  // leaf: first place; else: first of two children
    std::uint32_t count;  // places of a leaf, 0: not a leaf
  };
  void fitNodes(const std::vector<Eigen::AlignedBox3d>& boxes);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

}  // namespace curtain
