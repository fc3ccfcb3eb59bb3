// SPDX-License-Identifier: BSD-3-Clause
#include "parts/wind/wind_shadow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace curtain {
namespace {

constexpr double kSpread = 0.1;  // half-angle of the bundle of lines [rad]

// Where the bundle's lines start, about its middle, in its radii: a hexagon, and the middle itself.
constexpr double kHalfRoot = 0.86602540378443865;  // sin 60 degrees
constexpr std::array<std::array<double, 2>, 7> kStarts = {
    {{0, 0}, {1, 0}, {0.5, kHalfRoot}, {-0.5, kHalfRoot}, {-1, 0}, {-0.5, -kHalfRoot}, {0.5, -kHalfRoot}}};

bool isFinite(const Eigen::AlignedBox3d& box) { return std::isfinite(box.min().sum() + box.max().sum()); }

double distanceToLine(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 line = to - from;
  const double share = std::clamp((point - from).dot(line) / std::max(line.squaredNorm(), 1e-300), 0.0, 1.0);
  return (point - from - share * line).norm();
}

}  // namespace

bool mayShade(const ObstacleSet& obstacles, int index, const WindSource& wind) noexcept {
  if (!obstacles.present(index)) return false;
  const Eigen::AlignedBox3d box = obstacles.leftBox(index);
  return !isFinite(box) || wind.mayReach(box);
}

double WindShadow::shareAt(const Vec3& node, const WindSource& wind) const noexcept {
  const Vec3 start = wind.origin(node);
  const double width = kSpread * (node - start).norm();
  std::array<bool, kStarts.size()> blocked{};
  for (const InCone& obstacle : in_cone_) {
    if (distanceToLine(obstacle.centre, start, node) > obstacle.radius + width) continue;
    const Vec3 from = obstacle.place.toLocal(node);
    for (std::size_t k = 0; k < kStarts.size(); ++k) {
      if (blocked[k]) continue;
      const Vec3 beside = kStarts[k][0] * wind.across(0) + kStarts[k][1] * wind.across(1);
      SurfacePoint entry;
      blocked[k] = obstacle.shape->query(from, obstacle.place.toLocal(start + width * beside), 0.0, entry);
    }
  }
  const auto free = std::count(blocked.begin(), blocked.end(), false);
  return static_cast<double>(free) / static_cast<double>(kStarts.size());
}

void WindShadow::cast(const ObstacleSet& obstacles, const Grid& grid, const Field3& position, WindSource& wind) {
  if (!wind.params().shadow) return;
  in_cone_.clear();
  for (int index = 0; index < obstacles.count(); ++index) {
    if (!mayShade(obstacles, index, wind)) continue;
    const Eigen::AlignedBox3d box = obstacles.leftBox(index);
    const bool plane = !isFinite(box);
    const Transform place(obstacles.reached(index));
    in_cone_.push_back({&obstacles.shape(index), place, plane ? place.translation : Vec3(box.center()),
                        plane ? std::numeric_limits<double>::infinity() : 0.5 * box.sizes().norm()});
  }
  Field& shade = wind.shade();
  if (in_cone_.empty() && !layers_.any()) {
    if (wind.shaded()) std::fill(shade.begin(), shade.end(), 1.0);
    wind.setShaded(false);
    return;
  }
  wind.setShaded(true);
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      const Vec3 node = position.at(n);
      shade[n] = wind.reachesPoint(node) ? shareAt(node, wind) : 1.0;
    }
  }
  if (layers_.any()) layers_.cast(position, wind);
}

}  // namespace curtain
