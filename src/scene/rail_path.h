// SPDX-License-Identifier: BSD-3-Clause
//
// The curve of a rail: straight pieces and arcs, by arc length.
#pragma once

#include <string>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

/// Immutable, so thread-safe.
class RailPath {
 public:
  RailPath() = default;
  /// pieces: without a problem (problemOf()), or none.
  explicit RailPath(const std::vector<RailPiece>& pieces);

  /// What is wrong with piece `index`, which follows the one before it; empty: nothing.
  static std::string problemOf(const std::vector<RailPiece>& pieces, std::size_t index);

  double length() const noexcept { return length_; }  ///< [m]

  struct Place {
    Vec3 point = Vec3::Zero();      ///< [m]
    Vec3 tangent = Vec3::UnitX();   ///< unit, towards larger s
    Vec3 curvature = Vec3::Zero();  ///< change of the tangent along the path [1/m]
  };
  /// At arc length s [m], bounded to [0, length()]. At a corner: of the piece that begins there. With pieces only.
  Place at(double s) const noexcept;
  /// Arc length of a point of the path nearest to `point` [m].
  double nearest(const Vec3& point) const noexcept;

 private:
  struct Piece {
    double begin, length;     // along the path [m]
    Vec3 from, along;         // its first point and the tangent there
    double radius = 0.0;      // [m]; 0: straight
    Vec3 out = Vec3::Zero();  // from the arc's centre to `from`, unit
  };
  static Place placeOn(const Piece& piece, double way) noexcept;
  static double nearestOn(const Piece& piece, const Vec3& point) noexcept;

  std::vector<Piece> pieces_;
  double length_ = 0.0;
};

}  // namespace curtain
