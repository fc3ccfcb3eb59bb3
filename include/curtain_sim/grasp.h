// SPDX-License-Identifier: BSD-3-Clause
//
// Hands that hold the cloth: what is wrong with a grasp (GraspParams), and how one goes.
#pragma once

#include <string>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

/// Problems of a grasp's values on this cloth; keys begin with `key`.
std::vector<Problem> validate(const GraspParams& grasp, const ClothParams& cloth, const std::string& key);

/// How a grasp ended.
enum class GraspEnd {
  kNone,        ///< it holds
  kBroken,      ///< the pull reached break_force
  kSlippedOut,  ///< nothing was left between the pads
  kWaiting,     ///< a hand of the scene: it begins later
  kMissed,      ///< the same: where it took hold was no free node
  kReleased     ///< the same: its time was over
};

/// As Python, curtain_batch and logs spell it: "holds", "broken", "slipped_out", "waiting", "missed", "released".
const char* toString(GraspEnd end);

/// How a hand of the scene failed: it missed the cloth, or lost it. Empty: it did not.
std::string describeFailure(const HandParams& hand, GraspEnd end);

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
