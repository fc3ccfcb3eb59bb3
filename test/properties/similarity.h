// SPDX-License-Identifier: BSD-3-Clause
//
// The same scene seen otherwise: turned, mirrored, shifted, in other units. And motions brought back from there.
#pragma once

#include <cstddef>
#include <vector>

#include "curtain_sim/scene.h"
#include "properties/motion.h"

namespace curtain_test {

using curtain::Pose;
using curtain::Scene;
using curtain::Vec3;

enum class Across { kNone, kX, kY };

/// x' = length * turn * mirror * x + shift, and other units of time and mass.
struct Similarity {
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  Across mirror = Across::kNone;  ///< first, x or y is reversed
  Vec3 shift = Vec3::Zero();
  double length = 1.0, time = 1.0, mass = 1.0;

  Vec3 mirrored(const Vec3& d) const;
  Vec3 direction(const Vec3& d) const;
  Vec3 point(const Vec3& p) const;
  Vec3 back(const Vec3& p) const;
  Vec3 velocityBack(const Vec3& v) const;
  /// Of shapes that look the same when their own x or y is reversed (meshes are given a scale that reverses it).
  Pose pose(const Pose& p) const;
  double speed() const { return length / time; }
  double force() const { return mass * length / (time * time); }
  double pressure() const { return mass / (length * time * time); }
};

/// The scene as the similarity shows it. Open cloth; closed cloth only shifted, in other units, or turned about the
/// vertical with what is around it by whole links (see cycled()).
Scene seen(const Similarity& s, Scene scene);

/// A motion of the scene that was seen so, as the first scene's.
Motion seenBack(const Similarity& s, Motion motion);

/// The same cloth with its columns counted from the other end of the line.
Scene reversed(Scene scene);

/// Closed cloth with its columns counted from another one: what was column 0 is column `by`. Its own angles begin at
/// the +x axis, so what is around it turns by as many links about the vertical through its centre, and `turn` tells
/// how.
Scene cycled(Scene scene, int by, Similarity& turn);

/// A motion with its columns in another order: column j of the result was column from(j).
template <typename From>
Motion columnsFrom(Motion motion, const From& from) {
  const auto reorder = [&](std::vector<Vec3>& at) {
    const std::vector<Vec3> old = at;
    for (std::size_t n = 0; n < at.size(); ++n) {
      const auto columns = static_cast<std::size_t>(motion.columns);
      at[n] = old[n / columns * columns + static_cast<std::size_t>(from(static_cast<int>(n % columns)))];
    }
  };
  for (auto& at : motion.positions) reorder(at);
  for (auto& at : motion.velocities) reorder(at);
  return motion;
}

}  // namespace curtain_test
