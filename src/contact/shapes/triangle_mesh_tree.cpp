// SPDX-License-Identifier: BSD-3-Clause
#include "contact/shapes/triangle_mesh_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace curtain {
namespace {

/// Triangles in a leaf: fewer make a taller tree, more test triangles in vain; 4 is fastest by a little.
constexpr std::uint32_t kLeafSize = 4;

/// Depth is at most 32 (halving of a 32-bit count) and each level leaves one sibling behind.
constexpr int kStackSize = 64;

/// Squares of distances round by less, relative: of triangles that are equally far none is passed over.
constexpr double kRounding = 1e-12;

double distanceSquared(const Vec3& point, const Vec3& low, const Vec3& high) {
  return (low - point).cwiseMax(point - high).cwiseMax(0.0).squaredNorm();
}

/// Segment against triangle after Woop, Benthin, Wald 2013 (Watertight Ray/Triangle Intersection): the segment
/// is sheared onto an axis, and the edge functions of two triangles that share an edge are exact negatives of each
/// other, so no segment slips between them. Needs contraction to be off.
class Segment {
 public:
  Segment(const Vec3& from, const Vec3& to) : from_(from), way_(to - from) {
    way_.cwiseAbs().maxCoeff(&z_);
    x_ = (z_ + 1) % 3;
    y_ = (z_ + 2) % 3;
    shear_x_ = way_[x_] / way_[z_];
    shear_y_ = way_[y_] / way_[z_];
    shear_z_ = 1.0 / way_[z_];
  }

  /// Fraction of the segment where it meets the triangle's plane inside the triangle; false: it does not.
  bool hits(const std::array<Vec3, 3>& corners, double& fraction) const {
    std::array<Vec3, 3> local;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 corner = corners[i] - from_;
      local[i] = Vec3(corner[x_] - shear_x_ * corner[z_], corner[y_] - shear_y_ * corner[z_], shear_z_ * corner[z_]);
    }
    const double u = edge(local[1], local[2]);
    const double v = edge(local[2], local[0]);
    const double w = edge(local[0], local[1]);
    if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) {
      return false;
    }
    const double sum = u + v + w;
    if (sum == 0.0) {
      return false;  // the segment lies in the triangle's plane; its neighbours see the crossing
    }
    fraction = (u * local[0].z() + v * local[1].z() + w * local[2].z()) / sum;
    return fraction >= 0.0 && fraction <= 1.0;
  }

  /// Whether the segment up to `last` (a fraction) touches the box widened by margin; `first`: where.
  bool touches(const Vec3& low, const Vec3& high, double margin, double last, double& first) const {
    first = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double below = low[i] - margin - from_[i];
      const double above = high[i] + margin - from_[i];
      if (way_[i] == 0.0) {
        if (below > 0.0 || above < 0.0) {
          return false;
        }
        continue;
      }
      const double one = below / way_[i];
      const double other = above / way_[i];
      first = std::max(first, std::min(one, other));
      last = std::min(last, std::max(one, other));
    }
    return first <= last;
  }

 private:
  static double edge(const Vec3& p, const Vec3& q) { return p.x() * q.y() - p.y() * q.x(); }

  Vec3 from_;
  Vec3 way_;
  int x_ = 0;
  int y_ = 1;
  int z_ = 2;
  double shear_x_ = 0.0;
  double shear_y_ = 0.0;
  double shear_z_ = 0.0;
};

// Puts a triangle into its place; without room the furthest one is left out, and bounds all that are.
void insert(std::uint32_t place, double distance, NearTriangles& near) {
  std::size_t k = near.count;
  if (k == NearTriangles::kMost)
    near.radius = near.distances[--k];
  else
    ++near.count;
  if (distance >= near.radius) return;
  for (; k > 0 && near.distances[k - 1] > distance; --k) {
    near.distances[k] = near.distances[k - 1];
    near.places[k] = near.places[k - 1];
  }
  near.distances[k] = distance;
  near.places[k] = place;
}

}  // namespace

NearestTriangle nearestOnTriangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  // Ericson, Real-Time Collision Detection, 5.1.5: which Voronoi region of the triangle the point is in.
  NearestTriangle nearest;
  const auto at = [&](TriangleFeature feature, const Vec3& on) {
    nearest.feature = feature;
    nearest.point = on;
    nearest.distance_squared = (point - on).squaredNorm();
    return nearest;
  };
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 ap = point - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) {
    return at(TriangleFeature::kCornerA, a);
  }
  const Vec3 bp = point - b;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) {
    return at(TriangleFeature::kCornerB, b);
  }
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    return at(TriangleFeature::kEdgeAb, a + d1 / (d1 - d3) * ab);
  }
  const Vec3 cp = point - c;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) {
    return at(TriangleFeature::kCornerC, c);
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    return at(TriangleFeature::kEdgeCa, a + d2 / (d2 - d6) * ac);
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    return at(TriangleFeature::kEdgeBc, b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b));
  }
  const double sum = va + vb + vc;
  return at(TriangleFeature::kFace, a + vb / sum * ab + vc / sum * ac);
}

TriangleMeshTree::TriangleMeshTree(const ShapeTriangles& mesh) {
  const std::size_t count = mesh.triangles.size();
  std::vector<Vec3> centres(count);
  const auto corner = [&mesh](std::size_t triangle, int i) -> const Vec3& {
    return mesh.corners[static_cast<std::size_t>(mesh.triangles[triangle][i])];
  };
  for (std::size_t t = 0; t < count; ++t) {
    centres[t] = (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.0;
  }
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  nodes_.reserve(count + 1);
  nodes_.emplace_back();
  split(0, 0, static_cast<std::uint32_t>(count), centres, order, mesh);
  triangles_.resize(count);
  for (std::size_t t = 0; t < count; ++t) {
    triangles_[t].index = order[t];
    triangles_[t].corners = {corner(order[t], 0), corner(order[t], 1), corner(order[t], 2)};
  }
  const Eigen::AlignedBox3d box = bounds();
  margin_ = 1e-12 * (box.diagonal().norm() + box.min().cwiseAbs().maxCoeff());
}

void TriangleMeshTree::split(std::uint32_t node, std::uint32_t first, std::uint32_t count,
                             const std::vector<Vec3>& centres, std::vector<std::uint32_t>& order,
                             const ShapeTriangles& mesh) {
  const auto begin = order.begin() + first;
  const auto end = begin + count;
  if (count <= kLeafSize) {
    std::sort(begin, end);  // the order within a leaf does not depend on the standard library
    Eigen::AlignedBox3d box;
    for (auto t = begin; t != end; ++t) {
      for (const int corner : mesh.triangles[*t]) {
        box.extend(mesh.corners[static_cast<std::size_t>(corner)]);
      }
    }
    nodes_[node] = {box.min(), box.max(), first, count};
    return;
  }
  Eigen::AlignedBox3d spread;
  std::for_each(begin, end, [&](std::uint32_t t) { spread.extend(centres[t]); });
  int axis = 0;
  spread.sizes().maxCoeff(&axis);
  const std::uint32_t half = count / 2;
  std::nth_element(begin, begin + half, end, [&centres, axis](std::uint32_t one, std::uint32_t other) {
    const double x = centres[one][axis];
    const double y = centres[other][axis];
    return x < y || (x == y && one < other);
  });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  split(child, first, half, centres, order, mesh);
  split(child + 1, first + half, count - half, centres, order, mesh);
  nodes_[node] = {nodes_[child].low.cwiseMin(nodes_[child + 1].low),
                  nodes_[child].high.cwiseMax(nodes_[child + 1].high), child, 0};
}

// Takes the triangle if it is nearer than the best, or as near and comes first in the input.
bool TriangleMeshTree::take(const Vec3& point, std::uint32_t place, NearestTriangle& best) const noexcept {
  const Triangle& triangle = triangles_[place];
  NearestTriangle candidate = nearestOnTriangle(point, triangle.corners[0], triangle.corners[1], triangle.corners[2]);
  candidate.triangle = triangle.index;
  const bool better = candidate.distance_squared < best.distance_squared ||
                      (candidate.distance_squared == best.distance_squared && candidate.triangle < best.triangle);
  if (better) best = candidate;
  return better;
}

bool TriangleMeshTree::nearest(const Vec3& point, double limit_squared, NearestTriangle& out) const noexcept {
  struct Entry {
    std::uint32_t node;
    double distance_squared;
  };
  std::array<Entry, kStackSize> stack;
  std::size_t size = 0;
  bool found = false;
  NearestTriangle best;
  best.distance_squared = limit_squared;
  best.triangle = std::numeric_limits<std::uint32_t>::max();
  stack[size++] = {0, distanceSquared(point, nodes_[0].low, nodes_[0].high)};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (!(entry.distance_squared <= best.distance_squared * (1.0 + kRounding))) continue;
    const Node& node = nodes_[entry.node];
    if (node.count == 0) {
      const Node& left = nodes_[node.first];
      const Node& right = nodes_[node.first + 1];
      const Entry one{node.first, distanceSquared(point, left.low, left.high)};
      const Entry other{node.first + 1, distanceSquared(point, right.low, right.high)};
      const bool one_first = one.distance_squared <= other.distance_squared;
      stack[size++] = one_first ? other : one;
      stack[size++] = one_first ? one : other;
      continue;
    }
    for (std::uint32_t t = node.first; t < node.first + node.count; ++t) found = take(point, t, best) || found;
  }
  if (found) out = best;
  return found;
}

bool TriangleMeshTree::nearest(const Vec3& point, double limit_squared, double room, NearTriangles& near,
                               NearestTriangle& out) const noexcept {
  const double moved = (point - near.centre).norm();
  const double seen = near.radius - moved;
  if (seen > 0.0) {
    NearestTriangle best;
    best.distance_squared = seen * seen * (1.0 - kRounding);  // none of the others is as near
    best.triangle = 0;
    double distance = seen;
    bool found = false;
    for (std::size_t k = 0; k < near.count && near.distances[k] - moved <= distance * (1.0 + kRounding); ++k) {
      if (!take(point, near.places[k], best)) continue;
      distance = std::sqrt(best.distance_squared);
      found = true;
    }
    if (found || limit_squared <= best.distance_squared) {
      if (!(found && best.distance_squared <= limit_squared)) return false;
      out = best;
      return true;
    }
  }
  if (!nearest(point, limit_squared, out)) return false;
  collect(point, std::sqrt(out.distance_squared) + room, near);
  return true;
}

// The triangles nearest to a point, of those that come within a radius.
void TriangleMeshTree::collect(const Vec3& point, double radius, NearTriangles& near) const noexcept {
  near.centre = point;
  near.radius = radius;
  near.count = 0;
  std::array<std::uint32_t, kStackSize> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[stack[--size]];
    if (distanceSquared(point, node.low, node.high) > near.radius * near.radius) continue;
    if (node.count == 0) {
      stack[size++] = node.first + 1;
      stack[size++] = node.first;
      continue;
    }
    for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
      const std::array<Vec3, 3>& at = triangles_[t].corners;
      const double distance = std::sqrt(nearestOnTriangle(point, at[0], at[1], at[2]).distance_squared);
      if (distance < near.radius) insert(t, distance, near);
    }
  }
}

bool TriangleMeshTree::firstHit(const Vec3& from, const Vec3& to, double least_fraction,
                                TriangleHit& out) const noexcept {
  if (from == to) {
    return false;
  }
  const Segment segment(from, to);
  std::array<std::uint32_t, kStackSize> stack;
  int size = 0;
  bool found = false;
  double last = 1.0;
  stack[static_cast<std::size_t>(size++)] = 0;
  while (size > 0) {
    const Node& node = nodes_[stack[static_cast<std::size_t>(--size)]];
    double reached = 0.0;
    if (!segment.touches(node.low, node.high, margin_, last, reached)) {
      continue;
    }
    if (node.count == 0) {
      stack[static_cast<std::size_t>(size++)] = node.first + 1;
      stack[static_cast<std::size_t>(size++)] = node.first;
      continue;
    }
    for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
      double fraction = 0.0;
      if (segment.hits(triangles_[t].corners, fraction) && fraction >= least_fraction && (!found || fraction < last)) {
        found = true;
        last = fraction;
        out = {fraction, triangles_[t].index};
      }
    }
  }
  return found;
}

}  // namespace curtain
