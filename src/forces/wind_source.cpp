// SPDX-License-Identifier: BSD-3-Clause
#include "forces/wind_source.h"

#include <cmath>

#include "cloth/wide.h"

namespace curtain {
namespace {

constexpr double kTinySquared = 1e-300;  // keeps a division by a length from being one by zero; changes no other value
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
      gusts_(seedOf(seed, wind.id), wind.correlation_length, wind.correlation_time, pattern),
      distance_factor_(pattern.grid.size(), 0.0),
      gust_row_(static_cast<std::size_t>(pattern.grid.columns), 0.0) {
  if (wind.half_angle > kParallel) {
    apex_distance_ = wind.radius / std::tan(wind.half_angle);
    apex_ = wind.position - apex_distance_ * axis_;
  }
}

CURTAIN_INTO_WIDE WindSource::Sample WindSource::sample(double x, double y, double z) const noexcept {
  const double px = x - wind_.position[0], py = y - wind_.position[1], pz = z - wind_.position[2];
  const double depth = px * axis_[0] + py * axis_[1] + pz * axis_[2];
  // B lies where the line AC meets the disc's plane: the part of C across the axis, shrunk towards the apex.
  const double before = depth >= 0.0 ? depth : 0.0;
  const double shrink = apex_distance_ > 0.0 ? apex_distance_ / (apex_distance_ + before) : 1.0;
  const double bx = (px - depth * axis_[0]) * shrink, by = (py - depth * axis_[1]) * shrink,
               bz = (pz - depth * axis_[2]) * shrink;
  const double dx = px - bx, dy = py - by, dz = pz - bz;  // d = C - B
  // Its direction is that of the line AC (on the disc itself d is zero); parallel wind has the axis for a line.
  const double apart = apex_distance_ > 0.0 ? 1.0 : 0.0;
  const double reach = apex_distance_ > 0.0 ? apex_distance_ : 1.0;
  const double lx = apart * px + reach * axis_[0], ly = apart * py + reach * axis_[1], lz = apart * pz + reach * axis_[2];
  const double per_line = 1.0 / std::sqrt(lx * lx + ly * ly + lz * lz + kTinySquared);
  const bool reached = (depth >= 0.0) & (bx * bx + by * by + bz * bz <= wind_.radius * wind_.radius);
  Sample air;
  air.dx = lx * per_line;
  air.dy = ly * per_line;
  air.dz = lz * per_line;
  air.along = air.dx * axis_[0] + air.dy * axis_[1] + air.dz * axis_[2];
  const double factor = 1.0 / (wind_.distance_weight * (1.0 + dx * dx + dy * dy + dz * dz));
  air.distance_factor = reached ? factor : 0.0;
  return air;
}

WindAtPoint WindSource::at(const Vec3& point) const noexcept {
  const Sample here = sample(point.x(), point.y(), point.z());
  WindAtPoint air;
  air.reached = here.distance_factor > 0.0;
  if (!air.reached) return air;
  air.direction = Vec3(here.dx, here.dy, here.dz);
  air.along_axis = here.along;
  air.distance_factor = here.distance_factor;
  return air;
}

CURTAIN_WIDE void WindSource::addForces(const ClothPattern& pattern, const Field3& position, const Field3& area_vectors,
                           double time, Field3& force) noexcept {
  const Grid& grid = pattern.grid;
  const double ax = axis_[0], ay = axis_[1], az = axis_[2];
  for (int i = 0; i < grid.rows; ++i) {
    const std::size_t row = grid.row(i);
    const double* const x = position.x.data() + row;
    const double* const y = position.y.data() + row;
    const double* const z = position.z.data() + row;
    const double* const nx = area_vectors.x.data() + row;
    const double* const ny = area_vectors.y.data() + row;
    const double* const nz = area_vectors.z.data() + row;
    const double* const area = pattern.area.data() + row;
    double* const fx = force.x.data() + row;
    double* const fy = force.y.data() + row;
    double* const fz = force.z.data() + row;
    double* const reach = distance_factor_.data() + row;
#pragma omp simd
    for (int j = 0; j < grid.columns; ++j) {
      const Sample air = sample(x[j], y[j], z[j]);
      const double normal_size = std::sqrt(nx[j] * nx[j] + ny[j] * ny[j] + nz[j] * nz[j] + kTinySquared);
      // The cloth has two sides, so |cos psi|; a node crushed to no area catches no wind.
      const double cos_psi = std::abs(nx[j] * ax + ny[j] * ay + nz[j] * az) / normal_size;
      const double centre_force = wind_.pressure * area[j] + wind_.node_force;
      // Cheng 2000, Eq. (2): (f_w . d) d / |d|^2, with f_w along the axis; then Eq. (3).
      reach[j] = air.distance_factor;
      const double push = porosity_factor_ * centre_force * air.along * cos_psi * air.distance_factor;
      fx[j] += push * air.dx;
      fy[j] += push * air.dy;
      fz[j] += push * air.dz;
    }
  }
  if (wind_.unsteadiness > 0.0) addGusts(pattern, time, force);
}

// On the nodes that addForces just found in reach.
CURTAIN_WIDE void WindSource::addGusts(const ClothPattern& pattern, double time, Field3& force) noexcept {
  const Grid& grid = pattern.grid;
  gusts_.setTime(time - wind_.start);
  const double strength = wind_.unsteadiness * porosity_factor_;
  double* const gust = gust_row_.data();
  for (int i = 0; i < grid.rows; ++i) {
    const std::size_t row = grid.row(i);
    const double* const factor = distance_factor_.data() + row;
    const double* const area = pattern.area.data() + row;
    int component = 0;
    for (Field* const field : {&force.x, &force.y, &force.z}) {
      gusts_.rowOf(i, component++, gust);
      double* const f = field->data() + row;
#pragma omp simd
      for (int j = 0; j < grid.columns; ++j) f[j] += strength * area[j] * factor[j] * gust[j];
    }
  }
}

}  // namespace curtain
