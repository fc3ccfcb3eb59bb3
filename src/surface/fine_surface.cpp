// SPDX-License-Identifier: BSD-3-Clause
#include "surface/fine_surface.h"

#include <algorithm>
#include <cmath>

#include "surface/fold_turn.h"

namespace curtain {
namespace {

// Clearance that fine triangles should keep, as a share of the thickness: less than the first layer's, to leave room
// for folds.
constexpr double kShare = 0.1;
// Clearance that will do where the other would change the rods' lengths.
constexpr double kMinDistanceShare = 0.01;

}  // namespace

FineSurface::FineSurface(const ClothParams& cloth, const ClothPattern& pattern)
    : pattern_(pattern),
      shape_(cloth.folds),
      topology_(std::make_shared<const FineMeshTopology>(makeFineMeshTopology(cloth))),
      links_(pattern.grid.linkCount()),
      quad_triangles_{{0, 2, 1}, {1, 2, 3}} {
  area_vectors_.assign(pattern.grid.size(), 0.0);
  const auto row_points = static_cast<std::uint32_t>(cloth.folds + 1);
  for (std::uint32_t p = 0; p + 1 < row_points; ++p) {
    strip_triangles_.push_back({p, row_points + p, p + 1});
    strip_triangles_.push_back({p + 1, row_points + p, row_points + p + 1});
    rods_.push_back({p, p + 1, p + 1});
  }
  const std::size_t count = static_cast<std::size_t>(pattern.grid.rows) * static_cast<std::size_t>(links_);
  folds_.resize(count);
  strip_at_.assign(count, -1);
  strips_.reserve(count);
  points_.reserve(2 * row_points);
  kept_.reserve(2 * row_points);
}

void FineSurface::build(const Field3& position, ObstacleSet& obstacles, double thickness, FineMesh& out) {
  const Grid& grid = pattern_.grid;
  out.positions.resize(static_cast<std::size_t>(topology_->rows) * static_cast<std::size_t>(topology_->columns));
  out.flattened_folds = 0;
  position_ = &position;
  mesh_ = &out;
  wanted_ = kShare * thickness;
  least_ = kMinDistanceShare * thickness;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) node(i, j, 0) = position.at(grid.index(i, j));
  }
  if (topology_->folds == 1) return;
  nodeAreaVectors(grid, position, area_vectors_);
  for (int i = 0; i < grid.rows; ++i) {
    for (int link = 0; link < links_; ++link) place(i, link, 0.0);
  }
  findNear(position, obstacles);
  if (near_.empty()) return;
  findStrips();
  if (strips_.empty()) return;
  for (int i = 0; i < grid.rows; ++i) {
    for (int link = 0; link < links_; ++link) {
      if (fold(i, link).near) settleFold(i, link);
    }
  }
  settleStrips();
  for (const Fold& each : folds_) out.flattened_folds += each.stage != Stage::kFree;
}

Vec3& FineSurface::node(int row, int link, int p) {
  const int column = (link * topology_->folds + p) % topology_->columns;
  return mesh_->positions[static_cast<std::size_t>(row * topology_->columns + column)];
}

// Places the fold, turned by the angle about its chord.
void FineSurface::place(int row, int link, double angle) {
  const int column = (link + 1) % pattern_.grid.columns;
  if (!pattern_.grid.hasLink(row, column)) {  // no triangle has these nodes
    for (int p = 1; p < topology_->folds; ++p) node(row, link, p) = node(row, link, topology_->folds);
    return;
  }
  FoldArc arc = foldArc(pattern_.grid, pattern_.weft_rest, *position_, area_vectors_, row, column);
  if (angle != 0.0) {
    // With x along the chord: the bow points down in folds that bow along the cloth's normal, up in the others.
    const Vec3 across = (arc.second - arc.first).cross(arc.bow).normalized() * (column % 2 == 0 ? 1.0 : -1.0);
    arc.bow = std::cos(angle) * arc.bow + std::sin(angle) * across;
  }
  shape_.place(arc, &node(row, link, 1));
}

void FineSurface::findNear(const Field3& position, ObstacleSet& obstacles) {
  near_.clear();
  const Grid& grid = pattern_.grid;
  Eigen::AlignedBox3d box;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) box.extend(position.at(grid.index(i, j)));
  }
  const double reach = 0.5 * *std::max_element(pattern_.weft_rest.begin(), pattern_.weft_rest.end()) + wanted_;
  box.min().array() -= reach;
  box.max().array() += reach;
  for (int index = 0; index < obstacles.count(); ++index) {
    const MovingObstacle& obstacle = obstacles.moving(index);
    if (obstacle.present && obstacle.sweptBounds().intersects(box)) near_.push_back(&obstacle);
  }
}

// Finds the strips that an obstacle could touch at any turn of their folds: a fold lies in the ball of half its length
// around the middle of its chord.
void FineSurface::findStrips() {
  const Grid& grid = pattern_.grid;
  strips_.clear();
  for (Fold& each : folds_) each = Fold();
  std::fill(strip_at_.begin(), strip_at_.end(), -1);
  for (int i = 0; i + 1 < grid.rows; ++i) {
    for (int link = 0; link < links_; ++link) {
      const int right = (link + 1) % grid.columns;
      if (!grid.hasQuad(i, right)) continue;
      const Vec3 upper = 0.5 * (node(i, link, 0) + node(i, link, topology_->folds));
      const Vec3 lower = 0.5 * (node(i + 1, link, 0) + node(i + 1, link, topology_->folds));
      const Vec3 middle = 0.5 * (upper + lower);
      const double rest =
          std::max({pattern_.weft_rest[grid.index(i, right)], pattern_.weft_rest[grid.index(i + 1, right)],
                    (node(i, link, 0) - node(i, link, topology_->folds)).norm(),
                    (node(i + 1, link, 0) - node(i + 1, link, topology_->folds)).norm()});
      const double reach = 0.5 * rest + (upper - middle).norm() + wanted_;
      SurfacePoint surface;
      const bool is_near = std::any_of(near_.begin(), near_.end(), [&](const MovingObstacle* obstacle) {
        const Vec3 local = obstacle->after.toLocal(middle);
        return obstacle->shape->query(local, local, reach, surface) && surface.distance < reach;
      });
      if (!is_near) continue;
      fold(i, link).near = fold(i + 1, link).near = true;
      strip_at_[static_cast<std::size_t>(i * links_ + link)] = static_cast<std::int32_t>(strips_.size());
      strips_.push_back({i, link, clearanceOf(i, link)});
    }
  }
}

// The largest clearance that the strip's quad keeps: wanted, least, 0, or -1 for none.
double FineSurface::clearanceOf(int row, int link) {
  points_.clear();
  for (int i = row; i <= row + 1; ++i) {
    points_.push_back(node(i, link, 0));
    points_.push_back(node(i, link, topology_->folds));
  }
  for (const double clearance : {wanted_, least_, 0.0}) {
    if (keeps(quad_triangles_, clearance)) return clearance;
  }
  return -1.0;
}

// Whether points_, and the triangles over them, keep the clearance.
bool FineSurface::keeps(const std::vector<MeshTriangle>& triangles, double clearance) {
  return std::all_of(near_.begin(), near_.end(), [&](const MovingObstacle* obstacle) {
    return clearance_.keeps(*obstacle->shape, obstacle->after, points_, triangles, clearance);
  });
}

bool FineSurface::isClear(int row, int link, double clearance) {
  points_.clear();
  for (int i = row; i <= row + 1; ++i) {
    for (int p = 0; p <= topology_->folds; ++p) points_.push_back(node(i, link, p));
  }
  return keeps(strip_triangles_, clearance);
}

bool FineSurface::isRodClear(int row, int link, double clearance) {
  points_.clear();
  for (int p = 0; p <= topology_->folds; ++p) points_.push_back(node(row, link, p));
  return keeps(rods_, clearance);
}

// Turns the fold until its rods are clear; if its chord is inside an obstacle, moves its nodes out.
void FineSurface::settleFold(int row, int link) {
  for (const double clearance : {wanted_, least_}) {
    if (isRodClear(row, link, clearance)) return;
    const auto angle = minTurn([&](double turn) {
      place(row, link, turn);
      return isRodClear(row, link, clearance);
    });
    place(row, link, angle.value_or(0.0));
    fold(row, link).turn = angle.value_or(0.0);
    if (angle) return;
  }
  const Vec3 from = 0.5 * (node(row, link, 0) + node(row, link, topology_->folds));
  for (int p = 1; p < topology_->folds; ++p) {
    Vec3& moved = node(row, link, p);
    for (const MovingObstacle* obstacle : near_) {
      SurfacePoint surface;
      const Vec3 local = obstacle->after.toLocal(moved);
      if (!obstacle->shape->query(obstacle->after.toLocal(from), local, 0.0, surface) || surface.distance >= 0.0)
        continue;
      moved += obstacle->after.rotation * (surface.normal * (wanted_ - surface.distance));
      fold(row, link).stage = Stage::kLifted;
    }
  }
}

}  // namespace curtain
