// SPDX-License-Identifier: BSD-3-Clause
#include "forces/wind_source.h"

#include <cmath>

namespace curtain {
namespace {

constexpr double kParallel = 1e-6;  // [rad] half-angles below it are parallel wind: the apex would be 1e6 radii away

std::uint64_t seedOf(std::uint64_t seed, const std::string& id) {
  std::uint64_t hash = 1469598103934665603ULL ^ seed;  // FNV-1a, so that every source has gusts of its own
  for (const char letter : id) hash = (hash ^ static_cast<unsigned char>(letter)) * 1099511628211ULL;
  return hash;
}

}  // namespace

WindSource::WindSource(const WindParams& wind, const ClothPattern& pattern, double porosity, std::uint64_t seed)
    : wind_(wind),
      axis_(wind.direction.normalized()),
      porosity_factor_(1.0 - wind.porosity_weight * porosity),
      strength_(wind.pressure + wind.node_force + wind.unsteadiness),
      gusts_(seedOf(seed, wind.id), wind.correlation_length, wind.correlation_time, pattern) {
  if (wind.half_angle > kParallel) {
    apex_distance_ = wind.radius / std::tan(wind.half_angle);
    apex_ = wind.position - apex_distance_ * axis_;
  }
}

WindAtPoint WindSource::at(const Vec3& point) const noexcept {
  WindAtPoint air;
  const Vec3 from_centre = point - wind_.position;
  const double depth = from_centre.dot(axis_);
  if (depth < 0.0) return air;  // behind the disc
  // Offset of B from the centre, and d = C - B.
  const Vec3 across = from_centre - depth * axis_;
  const Vec3 disc_offset = apex_distance_ > 0.0 ? Vec3(across * (apex_distance_ / (apex_distance_ + depth))) : across;
  if (disc_offset.squaredNorm() > wind_.radius * wind_.radius) return air;
  const Vec3 d = from_centre - disc_offset;
  const double distance_squared = d.squaredNorm();
  // On the disc itself d is zero; its direction is that of the line AC.
  const Vec3 line = apex_distance_ > 0.0 ? Vec3(from_centre + apex_distance_ * axis_) : axis_;
  air.direction = line.normalized();
  air.reached = true;
  air.along_axis = air.direction.dot(axis_);
  air.distance_factor = 1.0 / (wind_.distance_weight * (1.0 + distance_squared));
  return air;
}

void WindSource::addForces(const ClothPattern& pattern, const Field3& position, const Field3& area_vectors,
                           double time, Field3& force) noexcept {
  const Grid& grid = pattern.grid;
  const bool gusty = wind_.unsteadiness > 0.0;
  if (gusty) gusts_.setTime(time - wind_.start);
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t node = grid.index(i, j);
      const WindAtPoint air = at(position.at(node));
      if (!air.reached) continue;
      const double share = porosity_factor_ * air.distance_factor;
      const Vec3 normal = area_vectors.at(node);
      const double normal_size = normal.norm();
      // The cloth has two sides, so |cos psi|; a node crushed to no area catches no wind.
      const double cos_psi = normal_size > 0.0 ? std::abs(normal.dot(axis_)) / normal_size : 0.0;
      const double centre_force = wind_.pressure * pattern.area[node] + wind_.node_force;
      // Cheng 2000, Eq. (2): (f_w . d) d / |d|^2, with f_w along the axis; then Eq. (3).
      Vec3 push = (centre_force * air.along_axis * cos_psi * share) * air.direction;
      if (gusty) push += (wind_.unsteadiness * pattern.area[node] * share) * gusts_.at(i, j);
      force.add(node, push);
    }
  }
}

}  // namespace curtain
