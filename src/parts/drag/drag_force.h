// SPDX-License-Identifier: BSD-3-Clause
//
// User forces on a node and its neighbourhood (Cheng 2000, end of Sect. 2.2: dragging with the mouse).
#pragma once

#include <vector>

#include "cloth/cloth.h"
#include "curtain_sim/scene.h"
#include "obstacles/pose_curve.h"

namespace curtain {

class DragForce {
 public:
  /// drag must be valid (validate()).
  DragForce(const DragParams& drag, const ClothPattern& pattern);

  const DragParams& params() const { return drag_; }
  bool actsAt(double time) const { return time >= drag_.start && time < drag_.end; }

  /// The target moves between these times [s].
  bool movesWithin(double from, double to) const noexcept {
    return path_.any() && to > drag_.start && from < drag_.end && path_.fastest(from, to, 0.0) > 0.0;
  }

  /// The grasped node; none before a drag by point first acts.
  const std::optional<NodeIndex>& node() const { return node_; }

  /// Grasps a node: for a drag by point, or one that replaces another with its id.
  void grasp(NodeIndex node, const ClothPattern& pattern) noexcept;

  /// True for a spring, which has a damper.
  bool damps() const { return drag_.target.has_value() || path_.any(); }

  /// Adds its forces [N], and for a spring its damping coefficients [kg/s]. end: until when the forces act [s], dt: how
  /// long [s]. Allocates nothing.
  void addForces(const ClothPattern& pattern, const Field3& position, double end, double dt, Field3& force,
                 Field& damping) noexcept;

 private:
  struct Share {
    std::size_t node;
    double weight;
  };
  void addSpring(const Field3& position, double end, double dt, Field3& force, Field& damping) const noexcept;

  DragParams drag_;
  std::optional<NodeIndex> node_;
  std::vector<Share> shares_;    // weights add up to one; has capacity for every node
  double spring_damping_ = 0.0;  // [kg/s]
  ScriptedMotion path_;          // of the target
};

/// The node nearest to a point.
NodeIndex nearestNode(const Grid& grid, const Field3& position, const Vec3& point) noexcept;

}  // namespace curtain
