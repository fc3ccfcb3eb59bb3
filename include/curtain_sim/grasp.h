// SPDX-License-Identifier: BSD-3-Clause
//
// Hands that hold the cloth: what Simulator::setGrasp() takes, and how a grasp goes.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

/// Which nodes a hand takes.
enum class GraspRegion {
  kSphere,  ///< those in a ball
  kBox,     ///< those in a box
  kNodes    ///< listed ones
};

/// A hand that takes hold of the cloth. What it holds moves with the gripper's frame.
///
/// Where nothing but releaseGrasp() ends it and it does not give, the held nodes are pinned. Otherwise each hangs on a
/// spring from its place in the frame (stiff: 0.05 mm at break_force), and is a free node of the cloth for all else.
struct GraspParams {
  std::string id;                             ///< unique among the grasps, not empty
  Pose frame;                                 ///< of the gripper in the world, when it takes hold
  GraspRegion region = GraspRegion::kSphere;  ///< decides which of the members below are read
  Pose place;                                 ///< of ball and box, centre and axes in the gripper's frame
  double radius = 0.0;                        ///< of the ball [m], > 0
  Vec3 size = Vec3::Zero();                   ///< of the box, edge lengths [m], > 0
  std::vector<NodeIndex> nodes;               ///< listed ones, each once
  double stiffness = std::numeric_limits<double>::infinity();    ///< of the hand [N/m], > 0; infinite: it does not give
  double break_force = std::numeric_limits<double>::infinity();  ///< pull that tears the cloth out of it [N], > 0
  /// Either of two pads presses with this [N], > 0: they hold by 2 friction pinch_force at most, and beyond that the
  /// cloth slides out between them. With a ball or a box, which is where the pads are. Infinite: it never slides.
  double pinch_force = std::numeric_limits<double>::infinity();
  double friction = 0.5;  ///< of the pads, Coulomb coefficient; > 0 with a pinch_force
};

/// Problems of a grasp's values on this cloth; keys begin with `key`.
std::vector<Problem> validate(const GraspParams& grasp, const ClothParams& cloth, const std::string& key);

/// How a grasp ended.
enum class GraspEnd {
  kNone,       ///< it holds
  kBroken,     ///< the pull reached break_force
  kSlippedOut  ///< nothing was left between the pads
};

/// A grasp after a frame.
struct GraspState {
  std::vector<NodeIndex> nodes;    ///< held now, row by row
  Vec3 force = Vec3::Zero();       ///< of the cloth on the hand, mean over the last frame with motion [N], along the
                                   ///< world's axes
  Vec3 torque = Vec3::Zero();      ///< the same about the origin of the gripper's frame [N m]
  double slipped = 0.0;            ///< way of the cloth between the pads, mean of the held nodes, summed up [m]
  GraspEnd end = GraspEnd::kNone;  ///< whether it holds, or why not
};

}  // namespace curtain
