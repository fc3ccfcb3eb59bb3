// SPDX-License-Identifier: BSD-3-Clause
//
// What is near a convex obstacle in one substep: nodes and faces whose boxes meet its own. Its nearest point is soon found, and a plane that
// touches it there once shows for ever how far nodes and faces are from it at least: that of a face's own nearest point, or of its nodes'.
#include <algorithm>
#include <limits>

#include "cloth/wide.h"
#include "contact/broad_phase/vicinity.h"
#include "contact/shapes/shapes.h"

namespace curtain {
namespace {

/// One component of places at both instants, and what the box leaves free below and above.
struct Component {
  const double *start, *end;
  double low, high;
};

CURTAIN_INTO_WIDE double lesser(double a, double b) { return a < b ? a : b; }
CURTAIN_INTO_WIDE double greater(double a, double b) { return a < b ? b : a; }

// How far the ways of `high` rows and `wide` columns of nodes from the jth on stay out of a slab.
CURTAIN_INTO_WIDE double outside(const Component& c, std::size_t j, std::size_t right, std::size_t down) {
  const double a = c.start[j], b = c.start[j + right], d = c.start[j + down], e = c.start[j + down + right];
  const double f = c.end[j], g = c.end[j + right], h = c.end[j + down], k = c.end[j + down + right];
  const double low = lesser(lesser(lesser(a, b), lesser(d, e)), lesser(lesser(f, g), lesser(h, k)));
  const double high = greater(greater(greater(a, b), greater(d, e)), greater(greater(f, g), greater(h, k)));
  return greater(c.low - high, low - c.high);
}

// Which nodes (right and down 0) or quads of a row have ways whose boxes meet one; returns whether any has.
CURTAIN_WIDE bool meeting(const Component* components, std::size_t right, std::size_t down, std::size_t count, std::uint8_t* __restrict meet) noexcept {
  const Component x = components[0], y = components[1], z = components[2];
  double any = 0.0;
#pragma omp simd reduction(+ : any)
  for (std::size_t j = 0; j < count; ++j) {
    const double most = greater(outside(x, j, right, down), greater(outside(y, j, right, down), outside(z, j, right, down)));
    const double meets = most <= 0.0 ? 1.0 : 0.0;
    any += meets;
    meet[j] = meets > 0.0 ? 1 : 0;
  }
  return any > 0.0;
}

std::array<Component, 3> componentsOf(const Field3& start, const Field3& end, std::size_t first, const Eigen::AlignedBox3d& box) {
  return {Component{&start.x[first], &end.x[first], box.min().x(), box.max().x()}, Component{&start.y[first], &end.y[first], box.min().y(), box.max().y()},
          Component{&start.z[first], &end.z[first], box.min().z(), box.max().z()}};
}

}  // namespace

void Vicinity::startConvex(const MovingObstacle& moving, const Field3& start) noexcept {
  ++substep_;
  toLocal(moving.before, start, start_);
  for (const std::uint32_t n : nodes_) distance_[n] = thickness_;
}

void Vicinity::listConvex(const MovingObstacle& moving, const Field3& end, double reach) noexcept {
  toLocal(moving.after, end, end_);
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
    const std::size_t first = grid.row(i);
    if (!meeting(componentsOf(start_, end_, first, box).data(), 0, 0, static_cast<std::size_t>(grid.columns), boxes_meet_.data())) continue;
    for (std::size_t j = 0; j < static_cast<std::size_t>(grid.columns); ++j) {
      if (boxes_meet_[j] == 0) continue;
      const std::size_t n = first + j;
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
    for (const std::uint32_t k : face.node) lowest = std::min({lowest, plane.height(start_.at(k)), plane.height(end_.at(k))});
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
  const auto add = [&](int i, int j) {
    const QuadElements quad = quadElements(grid, i, j);
    auto index = static_cast<std::uint32_t>(2 * grid.index(i, j));
    for (const MeshTriangle& triangle : quad.triangles) {
      const Face face{triangle, index++};
      if (!staysOver(face, reach)) faces_.push_back(face);
    }
  };
  for (int i = 0; i + 1 < grid.rows; ++i) {
    const bool any = meeting(componentsOf(start_, end_, grid.row(i), box).data(), 1, static_cast<std::size_t>(grid.stride),
                             static_cast<std::size_t>(grid.columns - 1), boxes_meet_.data());
    for (int j = 0; any && j + 1 < grid.columns; ++j) {
      if (boxes_meet_[static_cast<std::size_t>(j)] != 0) add(i, j);
    }
    if (grid.closed) add(i, grid.columns - 1);
  }
}

}  // namespace curtain
