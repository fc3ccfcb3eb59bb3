// SPDX-License-Identifier: BSD-3-Clause
#include "obstacles/box_tree.h"

#include <algorithm>
#include <numeric>

namespace curtain {
namespace {

/// Items in a leaf: fewer make a taller tree, more are tested in vain; 4 is fastest by a little.
constexpr std::uint32_t kLeafSize = 4;

std::vector<Vec3> centresOf(const std::vector<Eigen::AlignedBox3d>& boxes) {
  std::vector<Vec3> centres(boxes.size());
  std::transform(boxes.begin(), boxes.end(), centres.begin(),
                 [](const Eigen::AlignedBox3d& box) -> Vec3 { return box.min() + 0.5 * (box.max() - box.min()); });
  return centres;
}

}  // namespace

BoxTree::BoxTree(const std::vector<Eigen::AlignedBox3d>& boxes) : BoxTree(boxes, centresOf(boxes)) {}

BoxTree::BoxTree(const std::vector<Eigen::AlignedBox3d>& boxes, const std::vector<Vec3>& centres)
    : order_(boxes.size()) {
  const auto count = static_cast<std::uint32_t>(boxes.size());
  if (count == 0) return;
  std::iota(order_.begin(), order_.end(), 0U);
  // Parents come before their children. Nodes that are not split yet wait in the array as leaves.
  nodes_.reserve(count);
  nodes_.push_back({Vec3::Zero(), Vec3::Zero(), 0, count});
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const std::uint32_t first = nodes_[n].first;
    const std::uint32_t places = nodes_[n].count;
    const auto begin = order_.begin() + first;
    const auto end = begin + places;
    if (places <= kLeafSize) {
      std::sort(begin, end);  // the order within a leaf does not depend on the standard library
      continue;
    }
    Eigen::AlignedBox3d spread;
    std::for_each(begin, end, [&](std::uint32_t item) { spread.extend(centres[item]); });
    int axis = 0;
    spread.sizes().maxCoeff(&axis);
    const std::uint32_t half = places / 2;
    std::nth_element(begin, begin + half, end, [&centres, axis](std::uint32_t one, std::uint32_t other) {
      const double x = centres[one][axis];
      const double y = centres[other][axis];
      return x < y || (x == y && one < other);
    });
    nodes_[n].first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[n].count = 0;
    nodes_.push_back({Vec3::Zero(), Vec3::Zero(), first, half});
    nodes_.push_back({Vec3::Zero(), Vec3::Zero(), first + half, places - half});
  }
  fitNodes(boxes);
}

void BoxTree::fitNodes(const std::vector<Eigen::AlignedBox3d>& boxes) {
  for (std::size_t n = nodes_.size(); n-- > 0;) {  // children lie behind their parent
    Node& node = nodes_[n];
    if (node.count == 0) {
      node.low = nodes_[node.first].low.cwiseMin(nodes_[node.first + 1].low);
      node.high = nodes_[node.first].high.cwiseMax(nodes_[node.first + 1].high);
      continue;
    }
    Eigen::AlignedBox3d box;
    for (std::uint32_t place = node.first; place < node.first + node.count; ++place) box.extend(boxes[order_[place]]);
    node.low = box.min();
    node.high = box.max();
  }
}

}  // namespace curtain
