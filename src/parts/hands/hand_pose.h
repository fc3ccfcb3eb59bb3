// SPDX-License-Identifier: BSD-3-Clause
//
// Poses of a gripper's frame, and what is in a hand's region.
#pragma once

#include "curtain_sim/grasp.h"

namespace curtain {

inline Vec3 toWorld(const Pose& pose, const Vec3& local) noexcept { return pose.position + pose.orientation * local; }
inline Vec3 toLocal(const Pose& pose, const Vec3& world) noexcept {
  return pose.orientation.conjugate() * (world - pose.position);
}

inline Pose normalised(const Pose& pose) noexcept { return {pose.position, pose.orientation.normalized()}; }

inline Pose between(const Pose& from, const Pose& to, double share) noexcept {
  return {from.position + share * (to.position - from.position), from.orientation.slerp(share, to.orientation)};
}

/// at: in the gripper's frame [m].
inline bool isInRegion(const GraspParams& grasp, const Vec3& at) noexcept {
  const Vec3 local = toLocal(grasp.place, at);
  if (grasp.region == GraspRegion::kSphere) return local.norm() <= grasp.radius;
  return (2.0 * local.cwiseAbs() - grasp.size).maxCoeff() <= 0.0;
}

}  // namespace curtain
