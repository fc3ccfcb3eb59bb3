// SPDX-License-Identifier: BSD-3-Clause
#include "parts/air/ambient_wind.h"

#include <algorithm>
#include <cmath>

namespace curtain {

AmbientWind::AmbientWind(const AmbientParams& params)
    : velocity_(params.velocity), speed_(params.velocity.norm()), axes_(Eigen::Matrix3d::Identity()) {
  if (!(params.intensity * speed_ > 0.0)) return;
  gusts_.emplace(params.spectrum, params.intensity * speed_, params.length_scale, params.seed);
  // Gusts of level wind across it: to the side, and up.
  const Vec3 along = velocity_ / speed_;
  const Vec3 beside = std::abs(along.z()) < 0.9 ? Vec3::UnitZ() : Vec3::UnitX();
  axes_.col(0) = along;
  axes_.col(1) = beside.cross(along).normalized();
  axes_.col(2) = along.cross(axes_.col(1));
}

Vec3 AmbientWind::at(const Vec3& point, double time) const noexcept {
  return gusts_ ? gusty(point, upstreamAt(time)) : velocity_;
}

// Taylor's hypothesis: what is at the origin now was so far upstream at time 0, but for whole periods [m].
double AmbientWind::upstreamAt(double time) const noexcept { return std::fmod(speed_ * time, gusts_->period()); }

Vec3 AmbientWind::gusty(const Vec3& point, double upstream) const noexcept {
  const GustLine::Components gust = gusts_->at((upstream - axes_.col(0).dot(point)) / gusts_->spacing());
  return velocity_ + axes_ * Vec3(gust[0], gust[1], gust[2]);
}

void AmbientWind::setVelocities(const Grid& grid, const Field3& position, double time, Field3& out) const noexcept {
  if (!gusts_) {
    std::fill(out.x.begin(), out.x.end(), velocity_.x());
    std::fill(out.y.begin(), out.y.end(), velocity_.y());
    std::fill(out.z.begin(), out.z.end(), velocity_.z());
    return;
  }
  const double upstream = upstreamAt(time);
  for (int i = 0; i < grid.rows; ++i) {
    for (std::size_t n = grid.index(i, 0); n < grid.index(i, grid.columns); ++n)
      out.set(n, gusty(position.at(n), upstream));
  }
}

}  // namespace curtain
