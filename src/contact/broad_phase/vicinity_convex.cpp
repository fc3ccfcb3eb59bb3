// SPDX-License-Identifier: BSD-3-Clause
//
// What is near a convex obstacle in one substep: nodes and faces whose boxes meet its own. Its nearest point is soon
// found, and a plane that touches it there once shows for ever how far nodes and faces are from it at least: that of a
// face's own nearest point, or of its nodes'.
#include <algorithm>
#include <limits>

#include "contact/broad_phase/cloth_reach.h"
#include "contact/broad_phase/vicinity.h"
#include "contact/shapes/shapes.h"

namespace curtain {
namespace {

// The box around the ways of a row of nodes.
Eigen::AlignedBox3d boxOfRow(const Field3& start, const Field3& end, std::size_t first, std::size_t count) {
  const Range x = rangeOf(&start.x[first], &end.x[first], count);
  const Range y = rangeOf(&start.y[first], &end.y[first], count);
  const Range z = rangeOf(&start.z[first], &end.z[first], count);
  return {Vec3(x.low, y.low, z.low), Vec3(x.high, y.high, z.high)};
}

}  // namespace

void Vicinity::startConvex(const MovingObstacle& moving, const Field3& start) noexcept {
  ++substep_;
  toLocal(moving.before, start, start_);
  for (const std::uint32_t n : nodes_) distance_[n] = thickness_;
}

void Vicinity::listConvex(const MovingObstacle& moving, const Field3& end, double reach) noexcept {
  toLocal(moving.after, end, end_);
  for (int i = 0; i < pattern_.grid.rows; ++i) {
    row_boxes_[static_cast<std::size_t>(i)] =
        boxOfRow(start_, end_, pattern_.grid.row(i), static_cast<std::size_t>(pattern_.grid.columns));
  }
  const auto within = [this](double around) {
    const Eigen::AlignedBox3d box = shape_.bounds();
    return Eigen::AlignedBox3d(box.min().array() - around, box.max().array() + around);
  };
  listNodes(within(nodeReach()));
  if (elements_wanted_) listFaces(within(reach), reach);
}

// Finds a node's distance and plane where it starts, unless that is known.
void Vicinity::lookAtStart(std::size_t node) noexcept {
  if (looked_at_[node] == substep_) return;
  looked_at_[node] = substep_;
  const Vec3 at = start_.at(node);
  planes_[node] = {at, shape_.convex()->nearest(at), NodePlane::Kind::kFound};
  bound_[node] = planes_[node].surface.distance;
}

void Vicinity::listNodes(const Eigen::AlignedBox3d& box) noexcept {
  const Grid& grid = pattern_.grid;
  nodes_.clear();
  for (int i = 0; i < grid.rows; ++i) {
    if (!row_boxes_[static_cast<std::size_t>(i)].intersects(box)) continue;
    for (std::size_t n = grid.row(i); n < grid.index(i, grid.columns); ++n) {
      if (!Eigen::AlignedBox3d(start_.at(n)).extend(end_.at(n)).intersects(box)) continue;
      lookAtStart(n);
      const double distance = bound_[n];
      if (distance - (end_.at(n) - start_.at(n)).norm() > nodeReach()) continue;
      distance_[n] = std::min(distance, thickness_);
      nodes_.push_back(static_cast<std::uint32_t>(n));
    }
  }
}

// A plane has both ends of the face's way on its far side. What was found earlier is asked first.
bool Vicinity::staysOver(const Face& face, double reach) noexcept {
  const auto isOver = [&](const NodePlane& plane) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const std::uint32_t k : face.node)
      lowest = std::min({lowest, plane.height(start_.at(k)), plane.height(end_.at(k))});
    return lowest > reach;
  };
  const NodePlane& own = face_planes_[face.index];
  if (own.kind == NodePlane::Kind::kFound && isOver(own)) return true;
  for (const std::uint32_t node : face.node) {
    lookAtStart(node);
    if (isOver(planes_[node])) return true;
  }
  return false;
}

void Vicinity::listFaces(const Eigen::AlignedBox3d& box, double reach) noexcept {
  const Grid& grid = pattern_.grid;
  faces_.clear();
  const auto boxOf = [this](const std::array<std::uint32_t, 4>& corners) {
    Eigen::AlignedBox3d around;
    for (const std::uint32_t n : corners) around.extend(start_.at(n)).extend(end_.at(n));
    return around;
  };
  for (int i = 0; i + 1 < grid.rows; ++i) {
    if (!row_boxes_[static_cast<std::size_t>(i)].merged(row_boxes_[static_cast<std::size_t>(i) + 1]).intersects(box))
      continue;
    for (int j = 0; j < grid.linkCount(); ++j) {
      const QuadElements quad = quadElements(grid, i, j);
      if (!boxOf(quad.corners).intersects(box)) continue;
      auto index = static_cast<std::uint32_t>(2 * grid.index(i, j));
      for (const MeshTriangle& triangle : quad.triangles) {
        const Face face{triangle, index++};
        if (!staysOver(face, reach)) faces_.push_back(face);
      }
    }
  }
}

}  // namespace curtain
