// SPDX-License-Identifier: BSD-3-Clause
#include "parts/wind/wind_source.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/wide.h"
#include "scene/fnv1a.h"

namespace curtain {
namespace {

constexpr double kParallel = 1e-6;  // [rad] smaller half-angles are parallel wind: the apex would be 1e6 radii away

std::uint64_t seedOf(std::uint64_t seed, const std::string& id) {
  Fnv1a mixed;  // gives every source its own gusts
  mixed.hash ^= seed;
  mixed.addBytes(id.data(), id.size());
  return mixed.hash;
}

Field poresOf(const WindParams& wind, const Grid& grid, const Layers& layers) {
  Field pores(grid.size(), 0.0);
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j)
      pores[grid.index(i, j)] = 1.0 - wind.porosity_weight * layers.fabricAt(i, j).porosity;
  }
  return pores;
}

}  // namespace

WindSource::WindSource(const WindParams& wind, const ClothPattern& pattern, const Layers& layers, std::uint64_t seed)
    : wind_(wind),
      axis_(wind.direction.normalized()),
      pores_(poresOf(wind, pattern.grid, layers)),
      strength_(*std::max_element(pores_.begin(), pores_.end()) *
                (wind.pressure + wind.node_force + wind.unsteadiness)),
      steady_(wind.pressure + wind.node_force > 0.0),
      gusts_(seedOf(seed, wind.id), wind.correlation_length, wind.correlation_time, pattern),
      distance_factor_(pattern.grid.size(), 0.0),
      gust_row_(static_cast<std::size_t>(pattern.grid.columns), 0.0),
      rows_(static_cast<std::size_t>(pattern.grid.rows), 0),
      across_(axis_.unitOrthogonal()) {
  cone_ = {wind.position[0],
           wind.position[1],
           wind.position[2],
           axis_[0],
           axis_[1],
           axis_[2],
           wind.radius,
           0.0,
           wind.distance_weight,
           1.0 / wind.reference_length,
           0.0,
           1.0};
  if (wind.shadow) shade_.assign(pattern.grid.size(), 1.0);
  if (wind.half_angle > kParallel) {
    cone_.of_axis = cone_.apex_distance = wind.radius / std::tan(wind.half_angle);
    cone_.of_place = 1.0;
    widening_ = wind.radius / cone_.apex_distance;
  }
}

CURTAIN_INTO_WIDE double WindSource::Cone::distanceFactorAt(double x, double y, double z) const noexcept {
  const double px = x - ox, py = y - oy, pz = z - oz;
  const double depth = px * ax + py * ay + pz * az;
  // B, where the line AC meets the disc's plane: the part of C across the axis, scaled towards the apex.
  const double before = depth >= 0.0 ? depth : 0.0;
  const double shrink = apex_distance > 0.0 ? apex_distance / (apex_distance + before) : 1.0;
  const double bx = (px - depth * ax) * shrink, by = (py - depth * ay) * shrink, bz = (pz - depth * az) * shrink;
  // d = C - B, in reference lengths.
  const double dx = (px - bx) * per_length, dy = (py - by) * per_length, dz = (pz - bz) * per_length;
  const bool reached = (depth >= 0.0) & (bx * bx + by * by + bz * bz <= radius * radius);
  const double factor = 1.0 / (distance_weight * (1.0 + dx * dx + dy * dy + dz * dz));
  return reached ? factor : 0.0;
}

// The pressure below a rotor whose disc loading grows linearly from its hub (triangular loading: Heyson, Katzoff 1957,
// NACA Rep. 1319) and is rolled off at the tips: r (1 - r^8) over its maximum, r = |B| / radius. The maximum, 8/9 of
// 9^(-1/8), is at r = 9^(-1/8) = 0.76; the mean over the disc is 0.718.
CURTAIN_INTO_WIDE double WindSource::Cone::ringShareAt(double x, double y, double z) const noexcept {
  constexpr double kHighest = 0.67541;
  const double px = x - ox, py = y - oy, pz = z - oz;
  const double depth = px * ax + py * ay + pz * az;
  const double before = depth >= 0.0 ? depth : 0.0;
  const double shrink = apex_distance > 0.0 ? apex_distance / (apex_distance + before) : 1.0;
  const double bx = (px - depth * ax) * shrink, by = (py - depth * ay) * shrink, bz = (pz - depth * az) * shrink;
  const double square = (bx * bx + by * by + bz * bz) / (radius * radius);
  const double eighth = square * square * square * square;
  return eighth < 1.0 ? std::sqrt(square) * (1.0 - eighth) / kHighest : 0.0;
}

// Direction of the line AC, since d itself is zero on the disc; that of the axis for parallel wind.
CURTAIN_INTO_WIDE WindSource::Direction WindSource::Cone::directionAt(double x, double y, double z) const noexcept {
  const double px = x - ox, py = y - oy, pz = z - oz;
  const double lx = of_place * px + of_axis * ax, ly = of_place * py + of_axis * ay, lz = of_place * pz + of_axis * az;
  const double per_line = 1.0 / std::sqrt(lx * lx + ly * ly + lz * lz + kTinySquared);
  Direction d;
  d.x = lx * per_line;
  d.y = ly * per_line;
  d.z = lz * per_line;
  d.along = d.x * ax + d.y * ay + d.z * az;
  return d;
}

bool WindSource::reachesPoint(const Vec3& point) const noexcept {
  return cone_.distanceFactorAt(point.x(), point.y(), point.z()) > 0.0;
}

// A node is reached if it is not behind the disc and no further from the axis than r + k depth. The distance from the
// axis minus k depth is convex, so over the box it is above its tangent plane at the centre.
bool WindSource::mayReach(const Eigen::AlignedBox3d& box) const noexcept {
  constexpr double kRounding = 1e-9;
  const Vec3 half = 0.5 * box.sizes(), from = box.center() - wind_.position;
  const double depth = from.dot(axis_);
  const Vec3 across = from - depth * axis_;
  const double distance = across.norm();
  const double slack = kRounding * ((1.0 + widening_) * (from.norm() + half.norm()) + wind_.radius);
  if (depth + axis_.cwiseAbs().dot(half) < -slack) return false;
  if (distance <= wind_.radius) return true;
  const Vec3 slope = across / distance - widening_ * axis_;
  const double least = distance - widening_ * depth - slope.cwiseAbs().dot(half);
  return !(least > wind_.radius + slack);
}

void WindSource::find(const Grid& grid, const Field3& position, const Eigen::AlignedBox3d& bounds) noexcept {
  reaches_ = false;
  if (!mayReach(bounds)) return;
  for (int i = 0; i < grid.rows; ++i) {
    const bool reached = findInRow(grid, i, position);
    if (reached && wind_.profile == WindProfile::kRingJet) formRingInRow(grid, i, position);
    if (reached && shaded_) {
      for (std::size_t n = grid.row(i); n < grid.row(i + 1); ++n) distance_factor_[n] *= shade_[n];
    }
    rows_[static_cast<std::size_t>(i)] = reached ? 1 : 0;
    reaches_ = reaches_ || reached;
  }
}

CURTAIN_WIDE bool WindSource::findInRow(const Grid& grid, int i, const Field3& position) noexcept {
  const std::size_t row = grid.row(i);
  const ConstFieldView p(position, row);
  double* const factor = distance_factor_.data() + row;
  const Cone cone = cone_;
  double largest = 0.0;
#pragma omp simd reduction(max : largest)
  for (int j = 0; j < grid.columns; ++j) {
    const double here = cone.distanceFactorAt(p.x[j], p.y[j], p.z[j]);
    factor[j] = here;
    largest = largest > here ? largest : here;
  }
  return largest > 0.0;
}

CURTAIN_WIDE void WindSource::formRingInRow(const Grid& grid, int i, const Field3& position) noexcept {
  const std::size_t row = grid.row(i);
  const ConstFieldView p(position, row);
  double* const factor = distance_factor_.data() + row;
  const Cone cone = cone_;
#pragma omp simd
  for (int j = 0; j < grid.columns; ++j) factor[j] *= cone.ringShareAt(p.x[j], p.y[j], p.z[j]);
}

Vec3 WindSource::origin(const Vec3& point) const noexcept {
  const Vec3 from = point - wind_.position;
  const double depth = from.dot(axis_);
  const double shrink =
      cone_.apex_distance > 0.0 ? cone_.apex_distance / (cone_.apex_distance + std::max(depth, 0.0)) : 1.0;
  return wind_.position + shrink * (from - depth * axis_);
}

void WindSource::addForces(const ClothPattern& pattern, const Field3& position, const Field3& area_vectors, double time,
                           Field3& force) noexcept {
  const bool gusty = wind_.unsteadiness > 0.0;
  if (gusty) gusts_.setTime(time - wind_.start);
  for (int i = 0; i < pattern.grid.rows; ++i) {
    if (!reachesRow(i)) continue;
    if (steady_) addSteady(pattern, i, position, area_vectors, force);
    if (gusty) addGusts(pattern, i, force);
  }
}

CURTAIN_WIDE void WindSource::addSteady(const ClothPattern& pattern, int i, const Field3& position,
                                        const Field3& area_vectors, Field3& force) const noexcept {
  const Grid& grid = pattern.grid;
  const Cone cone = cone_;
  const double pressure = wind_.pressure, node_force = wind_.node_force;
  const std::size_t row = grid.row(i);
  const ConstFieldView p(position, row), normal(area_vectors, row);
  const double* const area = pattern.area.data() + row;
  const double* const factor = distance_factor_.data() + row;
  const double* const pores = pores_.data() + row;
  const FieldView f(force, row);
#pragma omp simd
  for (int j = 0; j < grid.columns; ++j) {
    const Direction d = cone.directionAt(p.x[j], p.y[j], p.z[j]);
    const double nx = normal.x[j], ny = normal.y[j], nz = normal.z[j];
    const double normal_size = std::sqrt(nx * nx + ny * ny + nz * nz + kTinySquared);
    // |cos psi|, since the cloth has two sides; a node without area catches no wind.
    const double cos_psi = std::abs(nx * cone.ax + ny * cone.ay + nz * cone.az) / normal_size;
    const double centre_force = pressure * area[j] + node_force;
    // Cheng 2000, Eq. (2): (f_w . d) d / |d|^2, with f_w along the axis; then Eq. (3).
    const double push = pores[j] * centre_force * d.along * cos_psi * factor[j];
    f.x[j] += push * d.x;
    f.y[j] += push * d.y;
    f.z[j] += push * d.z;
  }
}

CURTAIN_WIDE void WindSource::addGusts(const ClothPattern& pattern, int i, Field3& force) noexcept {
  const Grid& grid = pattern.grid;
  const double strength = wind_.unsteadiness;
  double* const gust = gust_row_.data();
  const std::size_t row = grid.row(i);
  const double* const pores = pores_.data() + row;
  const double* const factor = distance_factor_.data() + row;
  const double* const area = pattern.area.data() + row;
  int component = 0;
  for (Field* const field : {&force.x, &force.y, &force.z}) {
    gusts_.rowOf(i, component++, gust);
    double* const f = field->data() + row;
#pragma omp simd
    for (int j = 0; j < grid.columns; ++j) f[j] += strength * pores[j] * area[j] * factor[j] * gust[j];
  }
}

// ---- Velocities of the air

double WindSource::topSpeed(const ClothPattern& pattern, double density) const noexcept {
  double pressure = wind_.pressure;
  if (wind_.node_force > 0.0) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const double area : pattern.area) smallest = area > 0.0 ? std::min(smallest, area) : smallest;  // padding: 0
    pressure += wind_.node_force / smallest;
  }
  return std::sqrt(2.0 * pressure / (wind_.distance_weight * density));
}

void WindSource::addVelocities(const ClothPattern& pattern, const Field3& position, double time, double density,
                               Field3& velocity) noexcept {
  const bool gusty = wind_.unsteadiness > 0.0;
  if (gusty) gusts_.setTime(time - wind_.start);
  for (int i = 0; i < pattern.grid.rows; ++i) {
    if (!reachesRow(i)) continue;
    if (steady_) addSteadyVelocities(pattern, i, position, 2.0 / density, velocity);
    if (gusty) addGustVelocities(pattern.grid, i, 2.0 / density, velocity);
  }
}

CURTAIN_WIDE void WindSource::addSteadyVelocities(const ClothPattern& pattern, int i, const Field3& position,
                                                  double per_pressure, Field3& velocity) const noexcept {
  const Grid& grid = pattern.grid;
  const Cone cone = cone_;
  const double pressure = wind_.pressure, node_force = wind_.node_force;
  const std::size_t row = grid.row(i);
  const ConstFieldView p(position, row);
  const double* const area = pattern.area.data() + row;
  const double* const factor = distance_factor_.data() + row;
  const FieldView u(velocity, row);
#pragma omp simd
  for (int j = 0; j < grid.columns; ++j) {
    const Direction d = cone.directionAt(p.x[j], p.y[j], p.z[j]);
    const double here = (pressure + node_force / area[j]) * d.along * factor[j];  // along > 0 where factor is not 0
    const double speed = std::sqrt(per_pressure * (here > 0.0 ? here : 0.0));
    u.x[j] += speed * d.x;
    u.y[j] += speed * d.y;
    u.z[j] += speed * d.z;
  }
}

CURTAIN_WIDE void WindSource::addGustVelocities(const Grid& grid, int i, double per_pressure,
                                                Field3& velocity) noexcept {
  const double strength = per_pressure * wind_.unsteadiness;
  double* const gust = gust_row_.data();
  const std::size_t row = grid.row(i);
  const double* const factor = distance_factor_.data() + row;
  int component = 0;
  for (Field* const field : {&velocity.x, &velocity.y, &velocity.z}) {
    gusts_.rowOf(i, component++, gust);
    double* const u = field->data() + row;
#pragma omp simd
    for (int j = 0; j < grid.columns; ++j) {
      u[j] += std::copysign(std::sqrt(strength * factor[j] * std::abs(gust[j])), gust[j]);
    }
  }
}

}  // namespace curtain
