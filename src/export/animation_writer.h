// SPDX-License-Identifier: BSD-3-Clause
//
// What an animation is made of, between those who have it (a scene that runs, a bag) and those who write it.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "curtain_sim/drawn_mesh.h"
#include "curtain_sim/obstacle_shape.h"

namespace curtain {

/// What moves of a vertex of the cloth; single precision, as messages and files have it.
struct AnimatedVertex {
  std::array<float, 3> position;  ///< [m], world frame, z up
  std::array<float, 3> normal;    ///< unit
};

/// A rigid body.
struct AnimatedBody {
  std::string name;
  Vec3 color;  ///< red, green, blue as shown on a screen (sRGB) [0..1]
  ShapeTriangles shape;
};

/// Takes an animation, in the order of time. Throws std::invalid_argument for one that its file can't hold, and
/// std::runtime_error naming a file that can't be written.
class AnimationWriter {
 public:
  virtual ~AnimationWriter() = default;

  /// Once, before the first frame.
  virtual void setCloth(const std::vector<std::array<std::uint32_t, 3>>& triangles,
                        const std::vector<ClothCoordinate>& coordinates) = 0;

  /// vertices: as many as coordinates, finite. time: from the animation's start [s]; 0 first, then rising. ticks: of
  /// the frame rate, that this frame is for, >= 1; more where frames are rarer.
  virtual void addFrame(double time, const std::vector<AnimatedVertex>& vertices, int ticks) = 0;

  /// Returns the body's number.
  virtual std::size_t addBody(const AnimatedBody& body) = 0;

  /// Where a body is from this time on, and whether it is there. The last word counts: poses of the body that came
  /// before it and are of this time or a later one are dropped.
  virtual void addPose(std::size_t body, double time, const Pose& pose, bool present) = 0;
};

}  // namespace curtain
