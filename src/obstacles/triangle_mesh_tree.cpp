// SPDX-License-Identifier: BSD-3-Clause
#include "obstacles/triangle_mesh_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace curtain {
namespace {

/// A cache in which more triangles than these had to be looked at is made again around the point: sweeps ask from
/// nearly the same place again and again.
constexpr std::size_t kFew = 2;

/// Bound of the relative rounding of squared distances, so that none of several equally near triangles is missed.
constexpr double kRounding = 1e-12;

/// Segment against triangle (Woop, Benthin, Wald 2013, Watertight Ray/Triangle Intersection): the segment is sheared
/// onto an axis, and the edge functions of two triangles that share an edge are exact negatives of each other, so no
/// segment slips between. Needs FP contraction to be off.
class Segment {
 public:
  Segment(const Vec3& from, const Vec3& to) : from_(from), displacement_(to - from) {
    displacement_.cwiseAbs().maxCoeff(&z_);
    x_ = (z_ + 1) % 3;
    y_ = (z_ + 2) % 3;
    shear_x_ = displacement_[x_] / displacement_[z_];
    shear_y_ = displacement_[y_] / displacement_[z_];
    shear_z_ = 1.0 / displacement_[z_];
  }

  /// Fraction of the segment at which it meets the triangle; false: it does not.
  bool hits(const std::array<Vec3, 3>& corners, double& fraction) const {
    std::array<Vec3, 3> local;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 corner = corners[i] - from_;
      local[i] = Vec3(corner[x_] - shear_x_ * corner[z_], corner[y_] - shear_y_ * corner[z_], shear_z_ * corner[z_]);
    }
    const double u = edge(local[1], local[2]);
    const double v = edge(local[2], local[0]);
    const double w = edge(local[0], local[1]);
    if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) return false;
    const double sum = u + v + w;
    if (sum == 0.0) {
      return false;  // coplanar: the neighbours see the crossing
    }
    fraction = (u * local[0].z() + v * local[1].z() + w * local[2].z()) / sum;
    return fraction >= 0.0 && fraction <= 1.0;
  }

  /// Whether the segment up to `last` (a fraction) touches the box widened by margin [m].
  bool touches(const Vec3& low, const Vec3& high, double margin, double last) const {
    double first = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double below = low[i] - margin - from_[i];
      const double above = high[i] + margin - from_[i];
      if (displacement_[i] == 0.0) {
        if (below > 0.0 || above < 0.0) return false;
        continue;
      }
      const double one = below / displacement_[i];
      const double other = above / displacement_[i];
      first = std::max(first, std::min(one, other));
      last = std::min(last, std::max(one, other));
    }
    return first <= last;
  }

 private:
  static double edge(const Vec3& p, const Vec3& q) { return p.x() * q.y() - p.y() * q.x(); }

  Vec3 from_;
  Vec3 displacement_;
  int x_ = 0;
  int y_ = 1;
  int z_ = 2;
  double shear_x_ = 0.0;
  double shear_y_ = 0.0;
  double shear_z_ = 0.0;
};

// Puts a triangle where it belongs among the first k, which are in order.
void sift(std::size_t k, std::uint32_t place, double distance, NearTriangles& near) {
  for (; k > 0 && near.distances[k - 1] > distance; --k) {
    near.distances[k] = near.distances[k - 1];
    near.places[k] = near.places[k - 1];
  }
  near.distances[k] = distance;
  near.places[k] = place;
}

// When full the furthest is dropped and bounds all the dropped ones.
void insert(std::uint32_t place, double distance, NearTriangles& near) {
  std::size_t k = near.count;
  if (k == NearTriangles::kMost)
    near.radius = near.distances[--k];
  else
    ++near.count;
  if (distance < near.radius) sift(k, place, distance, near);
}

// Moves the centre by `moved` to a point from which the first `known` triangles are sqrt(squared) away; the others may
// have come nearer by as much.
void recentre(const Vec3& point, double moved, const std::array<double, NearTriangles::kMost>& squared,
              std::size_t known, NearTriangles& near) {
  near.centre = point;
  near.radius -= moved;
  for (std::size_t k = 0; k < near.count; ++k)
    sift(k, near.places[k], k < known ? std::sqrt(squared[k]) : near.distances[k] - moved, near);
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
  if (d1 <= 0.0 && d2 <= 0.0) return at(TriangleFeature::kCornerA, a);
  const Vec3 bp = point - b;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return at(TriangleFeature::kCornerB, b);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return at(TriangleFeature::kEdgeAb, a + d1 / (d1 - d3) * ab);
  const Vec3 cp = point - c;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return at(TriangleFeature::kCornerC, c);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return at(TriangleFeature::kEdgeCa, a + d2 / (d2 - d6) * ac);
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
  std::vector<Eigen::AlignedBox3d> boxes(count);
  triangles_.resize(count);
  const auto cornersOf = [&mesh](std::size_t triangle) -> std::array<Vec3, 3> {
    const auto corner = [&](int i) { return mesh.corners[static_cast<std::size_t>(mesh.triangles[triangle][i])]; };
    return {corner(0), corner(1), corner(2)};
  };
  for (std::size_t t = 0; t < count; ++t) {
    const std::array<Vec3, 3> corners = cornersOf(t);
    centres[t] = (corners[0] + corners[1] + corners[2]) / 3.0;
    for (const Vec3& corner : corners) boxes[t].extend(corner);
  }
  tree_ = BoxTree(boxes, centres);
  for (std::size_t t = 0; t < count; ++t) triangles_[t] = {cornersOf(tree_.order()[t]), tree_.order()[t]};
  const Eigen::AlignedBox3d box = bounds();
  margin_ = 1e-12 * (box.diagonal().norm() + box.min().cwiseAbs().maxCoeff());
}

// Takes the triangle if it is nearer than the best, or equally near and earlier in the input. squared: its distance
// [m^2].
bool TriangleMeshTree::improve(const Vec3& point, std::uint32_t place, NearestTriangle& best,
                               double& squared) const noexcept {
  const Triangle& triangle = triangles_[place];
  NearestTriangle candidate = nearestOnTriangle(point, triangle.corners[0], triangle.corners[1], triangle.corners[2]);
  candidate.triangle = triangle.index;
  squared = candidate.distance_squared;
  const bool better = candidate.distance_squared < best.distance_squared ||
                      (candidate.distance_squared == best.distance_squared && candidate.triangle < best.triangle);
  if (better) best = candidate;
  return better;
}

bool TriangleMeshTree::nearest(const Vec3& point, double limit_squared, NearestTriangle& out) const noexcept {
  bool found = false;
  NearestTriangle best;
  best.distance_squared = limit_squared;
  best.triangle = std::numeric_limits<std::uint32_t>::max();
  tree_.forEachLeafNear(
      point, [&] { return best.distance_squared * (1.0 + kRounding); },
      [&](std::uint32_t first, std::uint32_t last) {
        double squared = 0.0;
        for (std::uint32_t t = first; t < last; ++t) found = improve(point, t, best, squared) || found;
      });
  if (found) out = best;
  return found;
}

bool TriangleMeshTree::nearest(const Vec3& point, double limit_squared, double room, NearTriangles& near,
                               NearestTriangle& out) const noexcept {
  const double moved = (point - near.centre).norm();
  const double seen = near.radius - moved;
  if (seen > 0.0) {
    std::array<double, NearTriangles::kMost> squared;  // distances of those looked at [m^2]
    NearestTriangle best;
    best.distance_squared = seen * seen * (1.0 - kRounding);  // no triangle outside the cache is as near
    best.triangle = 0;
    double distance = seen;
    bool found = false;
    std::size_t k = 0;  // how many are looked at
    for (; k < near.count && near.distances[k] - moved <= distance * (1.0 + kRounding); ++k) {
      if (!improve(point, near.places[k], best, squared[k])) continue;
      distance = std::sqrt(best.distance_squared);
      found = true;
    }
    if (k > kFew) recentre(point, moved, squared, k, near);
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

// The triangles nearest to a point, of those within a radius.
void TriangleMeshTree::collect(const Vec3& point, double radius, NearTriangles& near) const noexcept {
  near.centre = point;
  near.radius = radius;
  near.count = 0;
  const auto within = [&](const Vec3& low, const Vec3& high) {
    return !(BoxTree::distanceSquared(point, low, high) > near.radius * near.radius);
  };
  tree_.forEachLeaf(within, [&](std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t t = first; t < last; ++t) {
      const std::array<Vec3, 3>& at = triangles_[t].corners;
      const double distance = std::sqrt(nearestOnTriangle(point, at[0], at[1], at[2]).distance_squared);
      if (distance < near.radius) insert(t, distance, near);
    }
  });
}

bool TriangleMeshTree::firstHit(const Vec3& from, const Vec3& to, double min_fraction,
                                TriangleHit& out) const noexcept {
  if (from == to) return false;
  const Segment segment(from, to);
  bool found = false;
  double last = 1.0;
  const auto touches = [&](const Vec3& low, const Vec3& high) { return segment.touches(low, high, margin_, last); };
  tree_.forEachLeaf(touches, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t t = begin; t < end; ++t) {
      double fraction = 0.0;
      if (segment.hits(triangles_[t].corners, fraction) && fraction >= min_fraction && (!found || fraction < last)) {
        found = true;
        last = fraction;
        out = {fraction, triangles_[t].index};
      }
    }
  });
  return found;
}

}  // namespace curtain
