// SPDX-License-Identifier: BSD-3-Clause
//
// The wind that blows everywhere: a mean velocity, and gusts that it carries along unchanged (frozen turbulence, Taylor
// 1938). The gusts vary along the wind only: across it, cloth is smaller than their length scale.
#pragma once

#include <optional>

#include "cloth/cloth.h"
#include "curtain_sim/scene.h"
#include "parts/air/gust_spectrum.h"

namespace curtain {

class AmbientWind {
 public:
  explicit AmbientWind(const AmbientParams& params);

  bool gusty() const noexcept { return gusts_.has_value(); }
  double meanSpeed() const noexcept { return speed_; }
  bool still() const noexcept { return speed_ == 0.0; }

  /// Velocity of the air at a point [m/s].
  Vec3 at(const Vec3& point, double time) const noexcept;
  /// Sets the velocity of the air at the nodes [m/s].
  void setVelocities(const Grid& grid, const Field3& position, double time, Field3& out) const noexcept;

 private:
  Vec3 gusty(const Vec3& point, double upstream) const noexcept;
  double upstreamAt(double time) const noexcept;

  Vec3 velocity_;
  double speed_;
  std::optional<GustLine> gusts_;
  Eigen::Matrix3d axes_;  // columns: along the wind, and two directions across it
};

}  // namespace curtain
