// SPDX-License-Identifier: BSD-3-Clause
//
// The mesh that the eye sees, from the nodes and the obstacles: folds whose bow would enter an obstacle are turned about
// their chord, away from it, which keeps every rod's length.
#pragma once

#include "cloth/folds.h"
#include "contact/obstacle_set.h"
#include "curtain_sim/fine_mesh.h"

namespace curtain {

class FineSurface {
 public:
  FineSurface(const ClothParams& cloth, const ClothPattern& pattern);

  const FineMeshTopology& topology() const { return topology_; }
  void build(const Field3& position, const ObstacleSet& obstacles, double thickness, FineMesh& out);

 private:
  void placeFold(const Field3& position, const ObstacleSet& obstacles, double thickness, int row, int column,
                 Vec3* inner);

  const ClothPattern& pattern_;
  FoldShape shape_;
  FineMeshTopology topology_;
  Field3 area_vectors_;
  std::vector<int> near_;  // obstacles that the cloth's box touches
};

}  // namespace curtain
