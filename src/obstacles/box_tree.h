// SPDX-License-Identifier: BSD-3-Clause
//
// Bounding volume hierarchy over the boxes of any items, built once. Halving along the longest side bounds the depth by
// log2(item count), so a fixed stack is enough. Nodes lie in one array, siblings side by side; an owner that keeps its
// items in the order of the leaves reads them in runs.
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
  /// Finite boxes, fewer than 2^32; none is allowed. Split by the boxes' centres, or by centres given for the items.
  /// O(n log n). The same input gives the same tree on every machine.
  explicit BoxTree(const std::vector<Eigen::AlignedBox3d>& boxes);
  BoxTree(const std::vector<Eigen::AlignedBox3d>& boxes, const std::vector<Vec3>& centres);

  /// Item (index into the boxes given) in each place of the leaves.
  const std::vector<std::uint32_t>& order() const { return order_; }
  /// Around all items; there must be one.
  Eigen::AlignedBox3d bounds() const { return {nodes_[0].low, nodes_[0].high}; }

  std::size_t nodeCount() const { return nodes_.size(); }
  /// Calls leaf(node, first, last) for the places [first, last) of a leaf and inner(node, child, other), children
  /// before those above them.
  template <typename Leaf, typename Inner>
  void forEachNodeUp(const Leaf& leaf, const Inner& inner) const {
    for (std::size_t n = nodes_.size(); n-- > 0;) {
      const Node& node = nodes_[n];
      if (node.count > 0)
        leaf(n, node.first, node.first + node.count);
      else
        inner(n, node.first, node.first + 1);
    }
  }

  /// Calls visit(first, last) for the places [first, last) of leaves whose boxes, and those above them, satisfy
  /// enters(low, high); forEachLeafOf: enters(node, low, high). Each place comes at most once. Allocates nothing.
  template <typename Enters, typename Visit>
  void forEachLeaf(const Enters& enters, const Visit& visit) const {
    const auto any = [&](std::uint32_t, const Vec3& low, const Vec3& high) { return enters(low, high); };
    forEachLeafOf(any, visit);
  }
  template <typename Enters, typename Visit>
  void forEachLeafOf(const Enters& enters, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, kStackSize> stack;
    std::size_t size = 0;
    stack[size++] = 0;
    while (size > 0) {
      const std::uint32_t index = stack[--size];
      const Node& node = nodes_[index];
      if (!enters(index, node.low, node.high)) continue;
      if (node.count > 0) {
        visit(node.first, node.first + node.count);
        continue;
      }
      stack[size++] = node.first + 1;
      stack[size++] = node.first;
    }
  }
  /// For all items whose box touches `box` (and a few others). A box that is empty or NaN gets none.
  template <typename Visit>
  void forEachRunIn(const Eigen::AlignedBox3d& box, const Visit& visit) const {
    const auto touches = [&box](const Vec3& low, const Vec3& high) {
      return (low.array() <= box.max().array()).all() && (high.array() >= box.min().array()).all();
    };
    forEachLeaf(touches, visit);
  }
  /// Nearest boxes first, those whose squared distance to a point is at most limit(), which may shrink meanwhile.
  template <typename Limit, typename Visit>
  void forEachLeafNear(const Vec3& point, const Limit& limit, const Visit& visit) const {
    struct Entry {
      std::uint32_t node;
      double distance_squared;
    };
    const auto entryOf = [&](std::uint32_t node) {
      return Entry{node, distanceSquared(point, nodes_[node].low, nodes_[node].high)};
    };
    std::array<Entry, kStackSize> stack;
    std::size_t size = 0;
    stack[size++] = entryOf(0);
    while (size > 0) {
      const Entry entry = stack[--size];
      if (!(entry.distance_squared <= limit())) continue;
      const Node& node = nodes_[entry.node];
      if (node.count > 0) {
        visit(node.first, node.first + node.count);
        continue;
      }
      const Entry one = entryOf(node.first), other = entryOf(node.first + 1);
      const bool one_first = one.distance_squared <= other.distance_squared;
      stack[size++] = one_first ? other : one;
      stack[size++] = one_first ? one : other;
    }
  }

  static double distanceSquared(const Vec3& point, const Vec3& low, const Vec3& high) {
    return (low - point).cwiseMax(point - high).cwiseMax(0.0).squaredNorm();
  }

 private:
  /// Depth is at most 32 (a 32-bit count is halved), and each level leaves one sibling on the stack.
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
