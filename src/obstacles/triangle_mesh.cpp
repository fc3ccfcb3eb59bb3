// SPDX-License-Identifier: BSD-3-Clause
#include "obstacles/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "obstacles/convex_shape.h"

namespace curtain {
namespace {

/// Cells of the distance grid: 8 per triangle; more than 8192 take longer to fill than the tree to build.
constexpr double kCellsPerTriangle = 8.0;
constexpr double kMaxCells = 8192.0;

/// Share of the coordinates below which the direction from the surface is rounding: 1e-16 / 1e-10 = 1e-6 rad.
constexpr double kTinyDistance = 1e-10;

}  // namespace

TriangleMeshShape::TriangleMeshShape(ShapeTriangles mesh)
    : topology_(analyseMesh(std::move(mesh))), features_(topology_, FlatEdges::kKeep), tree_(topology_.mesh) {
  const Eigen::AlignedBox3d box = tree_.bounds();
  tiny_ = kTinyDistance * std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  const double cells = std::min(kMaxCells, kCellsPerTriangle * static_cast<double>(topology_.mesh.triangles.size()));
  grid_ = std::make_unique<const DistanceGrid>(
      box, cells, [this](const Vec3& point, double bound) { return gridDistance(point, bound); });
}

double TriangleMeshShape::gridDistance(const Vec3& point, double bound) const {
  NearestTriangle nearest;
  if (!tree_.nearest(point, bound * bound, nearest)) {
    tree_.nearest(point, std::numeric_limits<double>::infinity(), nearest);  // the bound was too small by rounding
  }
  return surfacePoint(point, nearest).distance;
}

const Vec3& TriangleMeshShape::pseudonormal(const NearestTriangle& nearest) const noexcept {
  const std::size_t t = nearest.triangle;
  const Vec3& face = topology_.face_normals[t];
  switch (nearest.feature) {
    case TriangleFeature::kFace:
      return face;
    case TriangleFeature::kEdgeAb:
    case TriangleFeature::kEdgeBc:
    case TriangleFeature::kEdgeCa:
      return topology_.edge_normals[t][static_cast<std::size_t>(nearest.feature) -
                                       static_cast<std::size_t>(TriangleFeature::kEdgeAb)];
    default:
      break;
  }
  const int i = static_cast<int>(nearest.feature) - static_cast<int>(TriangleFeature::kCornerA);
  const Vec3& corner = topology_.corner_normals[static_cast<std::size_t>(topology_.mesh.triangles[t][i])];
  return corner == Vec3::Zero() ? face : corner;
}

SurfacePoint TriangleMeshShape::surfacePoint(const Vec3& point, const NearestTriangle& nearest) const noexcept {
  const Vec3& outward = pseudonormal(nearest);
  const Vec3 away = point - nearest.point;
  const double distance = std::sqrt(nearest.distance_squared);
  const double side = away.dot(outward) < 0.0 ? -1.0 : 1.0;
  SurfacePoint surface;
  if (topology_.watertight) {
    surface.distance = side * distance;
    surface.normal = outward;
  } else {
    surface.distance = distance;
    surface.normal = side * outward;
  }
  // At a face the gradient is its normal; at edges and corners the direction away from them, unless that is rounding.
  if (nearest.feature != TriangleFeature::kFace && distance > tiny_) {
    surface.normal = away / (topology_.watertight ? surface.distance : distance);
  }
  return surface;
}

bool TriangleMeshShape::entry(const Vec3& previous, const Vec3& current, SurfacePoint& out) const noexcept {
  const Vec3 displacement = current - previous;
  // A node that starts on a shell is on neither side and leaves freely. A solid knows its inside.
  const double min_fraction = topology_.watertight ? 0.0 : tiny_ / displacement.norm();
  TriangleHit hit;
  if (!tree_.firstHit(previous, current, min_fraction, hit)) return false;
  const Vec3& face = topology_.face_normals[hit.triangle];
  const bool from_behind = !topology_.watertight && face.dot(displacement) > 0.0;
  out.normal = from_behind ? Vec3(-face) : face;
  const auto corner = static_cast<std::size_t>(topology_.mesh.triangles[hit.triangle][0]);
  out.distance = out.normal.dot(current - topology_.mesh.corners[corner]);
  return out.distance < 0.0;  // otherwise the path leaves the solid
}

template <typename Search>
bool TriangleMeshShape::querySolid(const Vec3& previous, const Vec3& current, double reach, Search&& search,
                                   SurfacePoint& out) const noexcept {
  const double motion = (current - previous).norm();
  const DistanceGrid::Bracket bracket = grid_->bracket(current);
  const double wanted = std::max(reach, motion);
  if (!(bracket.low <= wanted)) {
    return false;  // outside, not within reach, and too far to have crossed
  }
  // If `current` may be inside, the surface must be found at any distance.
  const double bound = std::max(std::abs(bracket.low), std::abs(bracket.high));
  const double limit = bracket.low < 0.0 ? bound : std::min(wanted, bound);
  NearestTriangle nearest;
  if (!search(limit * limit, nearest)) return false;
  const SurfacePoint surface = surfacePoint(current, nearest);
  SurfacePoint entry_plane;
  if (std::abs(surface.distance) <= motion && entry(previous, current, entry_plane) &&
      (surface.distance >= 0.0 || surface.normal.dot(entry_plane.normal) < kSameSide)) {
    out = entry_plane;
    return true;
  }
  if (surface.distance > reach) return false;
  out = surface;
  return true;
}

template <typename Search>
bool TriangleMeshShape::queryShell(const Vec3& previous, const Vec3& current, double reach, Search&& search,
                                   SurfacePoint& out) const noexcept {
  const double motion = (current - previous).norm();
  const DistanceGrid::Bracket bracket = grid_->bracket(current);
  const double limit = std::min(std::max(reach, motion), bracket.high);
  NearestTriangle nearest;
  if (!(bracket.low <= limit) || !search(limit * limit, nearest)) return false;
  const SurfacePoint surface = surfacePoint(current, nearest);
  SurfacePoint entry_plane;
  if (surface.distance <= motion && entry(previous, current, entry_plane)) {
    out = entry_plane;
    return true;
  }
  if (surface.distance > reach) return false;
  out = surface;
  // On the shell only `previous` determines the side.
  if (surface.distance <= tiny_ && surface.normal.dot(previous - nearest.point) < 0.0) out.normal = -out.normal;
  return true;
}

bool TriangleMeshShape::query(const Vec3& previous, const Vec3& current, double reach,
                              SurfacePoint& out) const noexcept {
  return queryBy(
      previous, current, reach,
      [&](double limit, NearestTriangle& nearest) { return tree_.nearest(current, limit, nearest); }, out);
}

bool TriangleMeshShape::query(const Vec3& previous, const Vec3& current, double reach, double room, NearTriangles& near,
                              SurfacePoint& out) const noexcept {
  return queryBy(
      previous, current, reach,
      [&](double limit, NearestTriangle& nearest) { return tree_.nearest(current, limit, room, near, nearest); }, out);
}

}  // namespace curtain
