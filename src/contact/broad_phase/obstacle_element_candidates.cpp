// SPDX-License-Identifier: BSD-3-Clause
//
// Faces and edges of the cloth that may touch an obstacle. A tangent plane of a convex shape bounds the distance of a
// face from below: that of the face's own nearest point is tried first, then those of its nodes. For meshes see
// mesh_clearance.h.
#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/broad_phase/obstacle_candidates.h"
#include "contact/broad_phase/swept_directions.h"
#include "contact/narrow_phase/closest_points.h"
#include "obstacles/convex_shape.h"

namespace curtain {

Eigen::AlignedBox3d ObstacleCandidates::boxOf(const std::array<std::uint32_t, 4>& corners) const noexcept {
  Eigen::AlignedBox3d around;
  for (const std::uint32_t n : corners) around.extend(start_.at(n)).extend(end_.at(n));
  return around;
}

// Whether one of the cached planes has the whole motion of the face above it.
bool ObstacleCandidates::staysAbove(const Face& face, double reach) noexcept {
  const auto isOver = [&](const SeenSurface& plane) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const std::uint32_t k : face.node)
      lowest = std::min({lowest, plane.height(start_.at(k)), plane.height(end_.at(k))});
    return lowest > reach;
  };
  if (isOver(face_planes_[face.index])) return true;
  for (const std::uint32_t node : face.node) {
    queryStart(node);
    if (isOver(seen_[node])) return true;
  }
  return false;
}

void ObstacleCandidates::listFaces(double reach) noexcept {
  const Grid& grid = pattern_.grid;
  const Eigen::AlignedBox3d box = boundsWithin(reach);
  faces_.clear();
  for (int i = 0; i + 1 < grid.rows; ++i) {
    if (!boxOfRows(i).intersects(box)) continue;
    for (int j = 0; j < grid.linkCount(); ++j) {
      const QuadElements quad = quadElements(grid, i, j);
      if (!boxOf(quad.corners).intersects(box)) continue;
      auto index = static_cast<std::uint32_t>(2 * grid.index(i, j));
      for (int k = 0; k < quad.triangle_count; ++k) {
        const Face face{quad.triangles[static_cast<std::size_t>(k)], index++};
        if (!staysAbove(face, reach)) faces_.push_back(face);
      }
    }
  }
}

void ObstacleCandidates::listPairs(double reach) noexcept {
  const Eigen::AlignedBox3d box = boundsWithin(reach);
  const int rows = pattern_.grid.rows - 1, count = static_cast<int>(shares_.size());
  workers_.run(count, [&](int s) {
    Pairs& share = shares_[static_cast<std::size_t>(s)];
    share.list.clear();
    share.full = false;
    for (int i = rows * s / count; i < rows * (s + 1) / count; ++i) {
      if (boxOfRows(i).intersects(box)) listPairsOfRow(i, box, reach, share);
    }
  });
  pairs_.clear();
  full_ = false;
  for (const Pairs& share : shares_) {
    full_ = full_ || share.full || pairs_.size() + share.list.size() > pairs_.capacity();
    if (!full_) pairs_.insert(pairs_.end(), share.list.begin(), share.list.end());
  }
  if (full_) pairs_.clear();
}

void ObstacleCandidates::listPairsOfRow(int row, const Eigen::AlignedBox3d& box, double reach, Pairs& out) noexcept {
  const Grid& grid = pattern_.grid;
  const QuadClearance* const clearances = mesh_clearance_.classify(row, start_, end_, reach);
  for (int j = 0; j < grid.linkCount(); ++j) {
    QuadClearance clearance = clearances[j];
    if (clearance == QuadClearance::kClear) continue;
    const QuadElements quad = quadElements(grid, row, j);
    if (!boxOf(quad.corners).intersects(box)) continue;
    const SweptQuad swept(quad, start_, end_);
    if (clearance == QuadClearance::kUnknown) clearance = mesh_clearance_.rebuild(quad, swept, reach);
    if (clearance == QuadClearance::kNear) listPairsOf(quad, swept, reach, out);
  }
}

void ObstacleCandidates::listPairsOf(const QuadElements& quad, const SweptQuad& swept, double reach,
                                     Pairs& out) const noexcept {
  Eigen::AlignedBox3d box = boxOf(quad.corners);
  box.min().array() -= reach;
  box.max().array() += reach;
  const SweptDirections directions(quad, start_, end_);
  // The plane through the feature is a cheaper test than the distance.
  mesh_clearance_.forEachNear(
      quad, swept, directions, reach, box,
      [&](std::uint32_t index, const ObstacleEdge& edge) {
        if (swept.lowest(edge.outward, edge.ends[0]) > reach) return;
        for (int k = 0; k < quad.edge_count; ++k) {
          if (directions.edgeMeets(k, edge)) addEdgePair(quad.edges[static_cast<std::size_t>(k)], index, reach, out);
        }
      },
      [&](std::uint32_t index, const ObstacleVertex& corner) {
        if (swept.lowest(corner.outward, corner.position) > reach) return;
        for (int k = 0; k < quad.triangle_count; ++k) {
          if (directions.faceMeets(k, index, *shape_.features()))
            addCornerPair(quad.triangles[static_cast<std::size_t>(k)], index, reach, out);
        }
      });
}

// A node is never further than half its displacement from its position half way.
void ObstacleCandidates::addEdgePair(const MeshEdge& edge, std::uint32_t index, double reach,
                                     Pairs& out) const noexcept {
  const ObstacleEdge& other = shape_.features()->edges()[index];
  const Vec3 a = start_.at(edge[0]), b = start_.at(edge[1]);
  const Vec3 c = end_.at(edge[0]), d = end_.at(edge[1]);
  const double limit = reach + 0.5 * std::sqrt(std::max((c - a).squaredNorm(), (d - b).squaredNorm()));
  const Vec3 p = 0.5 * (a + c), q = 0.5 * (b + d);
  if (std::min(other.outward.dot(p - other.ends[0]), other.outward.dot(q - other.ends[0])) > limit) return;
  if (closestOnSegments(p, q, other.ends[0], other.ends[1]).distance_squared > limit * limit) return;
  out.add({{edge[0], edge[1], 0}, index, true});
}

void ObstacleCandidates::addCornerPair(const MeshTriangle& triangle, std::uint32_t index, double reach,
                                       Pairs& out) const noexcept {
  const ObstacleVertex& corner = shape_.features()->vertices()[index];
  std::array<Vec3, 3> at;
  double longest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 now = start_.at(triangle[k]), then = end_.at(triangle[k]);
    at[k] = 0.5 * (now + then);
    longest = std::max(longest, (then - now).squaredNorm());
  }
  const double limit = reach + 0.5 * std::sqrt(longest);
  if (closestOnTriangle(corner.position, at[0], at[1], at[2]).distance_squared > limit * limit) return;
  out.add({triangle, index, false});
}

}  // namespace curtain
