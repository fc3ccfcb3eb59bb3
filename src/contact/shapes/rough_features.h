// SPDX-License-Identifier: BSD-3-Clause
//
// Edges and corners of a mesh that an edge or a face of the cloth can come nearer to than the core while the nodes keep their
// distance: those the surface falls away from. Of a mesh that is finer than the cloth and bends gently there are none.
//
//      node          node       The nodes are at least `kept` over the surface, which is no deeper under the plane of a
//       o-----p-------o         corner v than z(r) = flat + curvature r^2 / 2. So a point p of the element is over the plane
//     . '     q         ' .     by kept - flat - curvature / 2 mean r^2, with the mean over its nodes.
#pragma once

#include <cstdint>
#include <vector>

#include "contact/shapes/box_tree.h"
#include "contact/shapes/obstacle_features.h"

namespace curtain {

/// What is known of the cloth [m].
struct ClothGaps {
  double longest;  ///< edge of an element
  double kept;     ///< least distance of a node
  double core;     ///< least distance that an element shall keep
};

class RoughFeatures {
 public:
  RoughFeatures() = default;
  /// O(features x triangles within the cloth's longest edge of one). `features` must outlive this.
  RoughFeatures(const ObstacleFeatures& features, const ClothGaps& gaps);

  bool empty() const noexcept { return edges_.empty() && vertices_.empty(); }
  bool isRoughEdge(std::size_t edge) const noexcept { return is_rough_edge_[edge] != 0; }
  bool isRoughVertex(std::size_t vertex) const noexcept { return is_rough_vertex_[vertex] != 0; }

  /// As of ObstacleFeatures, of the touchable and rough ones alone.
  template <typename F>
  void forEachEdgeIn(const Eigen::AlignedBox3d& box, F&& f) const {
    edge_tree_.forEachRunIn(box, [&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t n = first; n < last; ++n) f(edges_[n], features_->edges()[edges_[n]]);
    });
  }
  template <typename F>
  void forEachVertexIn(const Eigen::AlignedBox3d& box, F&& f) const {
    vertex_tree_.forEachRunIn(box, [&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t n = first; n < last; ++n) f(vertices_[n], features_->vertices()[vertices_[n]]);
    });
  }

 private:
  const ObstacleFeatures* features_ = nullptr;
  std::vector<std::uint32_t> edges_, vertices_;  // in the order of the trees
  std::vector<std::uint8_t> is_rough_edge_, is_rough_vertex_;
  BoxTree edge_tree_, vertex_tree_;
};

}  // namespace curtain
