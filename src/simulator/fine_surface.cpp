// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/fine_surface.h"

#include <algorithm>
#include <cmath>

namespace curtain {
namespace {

// Shares of the turn towards the way out that are tried, the least that clears the obstacle wins.
constexpr int kTurns = 4;

// How far the deepest of the points is short of `clearance` outside the obstacle, and the way out there.
double shortfall(const MovingObstacle& obstacle, const Vec3* points, int count, const Vec3& from, double clearance,
                 Vec3& way_out) {
  double worst = 0.0;
  for (int p = 0; p < count; ++p) {
    SurfacePoint surface;
    const Vec3 local = obstacle.after.toLocal(points[p]);
    if (!obstacle.shape->query(obstacle.after.toLocal(from), local, clearance, surface)) continue;
    if (clearance - surface.distance <= worst) continue;
    worst = clearance - surface.distance;
    way_out = obstacle.after.rotation * surface.normal;
  }
  return worst;
}

}  // namespace

FineSurface::FineSurface(const ClothParams& cloth, const ClothPattern& pattern)
    : pattern_(pattern), shape_(cloth.folds), topology_(makeFineMeshTopology(cloth)) {
  area_vectors_.assign(pattern.grid.size(), 0.0);
}

void FineSurface::placeFold(const Field3& position, const ObstacleSet& obstacles, double thickness, int row, int column,
                            Vec3* inner) {
  FoldArc arc = foldArc(pattern_, position, area_vectors_, row, column);
  const int count = shape_.rodCount() - 1;
  shape_.place(arc, inner);
  const Vec3 chord = arc.second - arc.first;
  const Vec3 middle = 0.5 * (arc.first + arc.second);
  for (const int index : near_) {
    const MovingObstacle& obstacle = obstacles.moving()[static_cast<std::size_t>(index)];
    const double clearance = 0.5 * thickness;  // nodes keep the whole of it; the fold may lie closer
    Vec3 way_out;
    if (shortfall(obstacle, inner, count, middle, clearance, way_out) <= 0.0) continue;
    Vec3 away = way_out;
    if (chord.squaredNorm() > 0.0) away -= chord * (away.dot(chord) / chord.squaredNorm());
    if (away.norm() < 1e-6) continue;  // the chord runs straight at the obstacle: no turn helps
    away.normalize();
    const Vec3 bow = arc.bow;
    for (int turn = 1; turn <= kTurns; ++turn) {
      const double share = static_cast<double>(turn) / kTurns;
      const Vec3 turned = (1.0 - share) * bow + share * away;
      if (turned.norm() < 1e-6) continue;
      arc.bow = turned.normalized();
      shape_.place(arc, inner);
      Vec3 unused;
      if (shortfall(obstacle, inner, count, middle, clearance, unused) <= 0.0) break;
    }
  }
  // Where a hollow leaves no turn that clears, the points themselves are set outside; their rods stretch for it.
  for (const int index : near_) {
    const MovingObstacle& obstacle = obstacles.moving()[static_cast<std::size_t>(index)];
    for (int p = 0; p < count; ++p) {
      SurfacePoint surface;
      const Vec3 local = obstacle.after.toLocal(inner[p]);
      if (!obstacle.shape->query(obstacle.after.toLocal(middle), local, 0.0, surface) || surface.distance >= 0.0) continue;
      inner[p] += obstacle.after.rotation * (surface.normal * (0.1 * thickness - surface.distance));
    }
  }
}

void FineSurface::build(const Field3& position, const ObstacleSet& obstacles, double thickness, FineMesh& out) {
  const Grid& grid = pattern_.grid;
  out.positions.resize(static_cast<std::size_t>(topology_.rows) * static_cast<std::size_t>(topology_.columns));
  near_.clear();
  if (topology_.folds > 1) {
    nodeAreaVectors(grid, position, area_vectors_);
    Eigen::AlignedBox3d box;
    for (int i = 0; i < grid.rows; ++i) {
      for (int j = 0; j < grid.columns; ++j) box.extend(position.at(grid.index(i, j)));
    }
    const double widest = *std::max_element(pattern_.weft_rest.begin(), pattern_.weft_rest.end());
    box.min().array() -= widest;
    box.max().array() += widest;
    for (int n = 0; n < obstacles.count(); ++n) {
      const MovingObstacle& obstacle = obstacles.moving()[static_cast<std::size_t>(n)];
      if (obstacle.present && obstacle.sweptBounds().intersects(box)) near_.push_back(n);
    }
  }
  for (int i = 0; i < grid.rows; ++i) {
    Vec3* const row = out.positions.data() + static_cast<std::size_t>(i * topology_.columns);
    for (int j = 0; j < grid.columns; ++j) row[j * topology_.folds] = position.at(grid.index(i, j));
    if (topology_.folds == 1) continue;
    for (int j = grid.closed ? 0 : 1; j < grid.columns; ++j) {
      const int left = j > 0 ? j - 1 : grid.columns - 1;
      placeFold(position, obstacles, thickness, i, j, row + left * topology_.folds + 1);
    }
  }
}

}  // namespace curtain
