// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/obstacle_candidates.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/wide.h"
#include "obstacles/convex_shape.h"

namespace curtain {
namespace {

// Capacity for pairs with a mesh, per node of the cloth and per edge or corner of the mesh (either may be the finer
// one). When it runs out the cloth stops, and a mesh that moves on goes through it.
constexpr std::size_t kPairsPerNode = 8;
constexpr std::size_t kPairsPerFeature = 4;
// Parts of the cloth that look for pairs side by side, and the capacity of each as a share of the whole: the same for
// any number of threads, and so is what there is room for.
constexpr std::size_t kShares = 8;
constexpr std::size_t kSharesThatFit = 2;

// Upper bound of a diagonal, which no link holds.
double longestEdge(const ClothPattern& pattern) {
  double warp = 0.0, weft = 0.0;
  forEachLink(pattern, [&](std::size_t, std::size_t, double rest, bool rod) {
    double& longest = rod ? warp : weft;
    longest = std::max(longest, rest);
  });
  return warp + weft;
}

struct Range {
  double low, high;
};

// Range of two arrays.
CURTAIN_WIDE Range rangeOf(const double* a, const double* b, std::size_t count) {
  double low = a[0], high = a[0];
#pragma omp simd reduction(min : low) reduction(max : high)
  for (std::size_t n = 0; n < count; ++n) {
    const double least = a[n] < b[n] ? a[n] : b[n];
    const double most = a[n] < b[n] ? b[n] : a[n];
    low = low < least ? low : least;
    high = high > most ? high : most;
  }
  return {low, high};
}

// Box around the motion of a row of nodes.
Eigen::AlignedBox3d boxOfRow(const Field3& start, const Field3& end, std::size_t first, std::size_t count) {
  const Range x = rangeOf(&start.x[first], &end.x[first], count);
  const Range y = rangeOf(&start.y[first], &end.y[first], count);
  const Range z = rangeOf(&start.z[first], &end.z[first], count);
  return {Vec3(x.low, y.low, z.low), Vec3(x.high, y.high, z.high)};
}

}  // namespace

Eigen::AlignedBox3d boxAround(const Grid& grid, const Field3& start, const Field3& end) noexcept {
  Eigen::AlignedBox3d box;
  const auto columns = static_cast<std::size_t>(grid.columns);
  for (int i = 0; i < grid.rows; ++i) box.extend(boxOfRow(start, end, grid.row(i), columns));
  return box;
}

ObstacleCandidates::ObstacleCandidates(const ClothPattern& pattern, const ContactShape& shape, const ObstacleGaps& gaps,
                                       const Workers& workers)
    : pattern_(pattern),
      shape_(shape),
      workers_(workers),
      mesh_(dynamic_cast<const TriangleMeshShape*>(&shape)),
      gaps_(gaps) {
  // Elements need tests of their own if the longest edge between two nodes at the thickness (less the tenth they may
  // lack) can come nearer than the core: by the sagitta of a circle of the padded surface's smallest radius.
  const double longest = longestEdge(pattern);
  const double smooth = shape.convex() != nullptr ? shape.convex()->smoothRadius() : 0.0;
  const double radius = smooth + gaps.padding + 0.9 * gaps.thickness;
  const double half = 0.5 * longest;
  const double sagitta = half < radius ? radius - std::sqrt((radius - half) * (radius + half)) : radius;
  elements_wanted_ = std::isfinite(radius) && sagitta > 0.9 * gaps.thickness - gaps.core;
  const std::size_t size = pattern.grid.size(), count = pattern.grid.nodeCount();
  for (Field3* field : {&start_, &end_}) field->assign(size, 0.0);
  seen_.resize(size);
  distance_.assign(size, thickness());
  nodes_.reserve(count);
  near_.assign(size, 0);
  ends_.reserve(count);
  found_.reserve(count);
  queried_at_.assign(size, 0);
  row_boxes_.resize(static_cast<std::size_t>(pattern.grid.rows));
  if (mesh_ != nullptr) triangles_.resize(size);
  if (shape.features() != nullptr) {
    const std::size_t room = kPairsPerNode * count + kPairsPerFeature * (shape.features()->edges().size() +
                                                                         shape.features()->vertices().size());
    pairs_.reserve(room);
    shares_.resize(kShares);
    for (Pairs& share : shares_) share.list.reserve(room / kSharesThatFit);
    mesh_clearance_ = MeshClearance(pattern.grid, shape);
  } else if (elements_wanted_) {
    faces_.reserve(2 * count);
    face_planes_.resize(2 * size);
  }
}

// World to obstacle's frame.
CURTAIN_WIDE void ObstacleCandidates::toLocal(const Transform& place, const Field3& position, Field3& out) noexcept {
  const Eigen::Matrix3d& r = place.rotation;
  const double xx = r(0, 0), xy = r(1, 0), xz = r(2, 0), yx = r(0, 1), yy = r(1, 1), yz = r(2, 1);
  const double zx = r(0, 2), zy = r(1, 2), zz = r(2, 2);
  const double tx = place.translation.x(), ty = place.translation.y(), tz = place.translation.z();
  const double *const px = position.x.data(), *const py = position.y.data(), *const pz = position.z.data();
  double *const ox = out.x.data(), *const oy = out.y.data(), *const oz = out.z.data();
  const std::size_t size = position.x.size();
#pragma omp simd
  for (std::size_t n = 0; n < size; ++n) {
    const double x = px[n] - tx, y = py[n] - ty, z = pz[n] - tz;
    ox[n] = xx * x + xy * y + xz * z;
    oy[n] = yx * x + yy * y + yz * z;
    oz[n] = zx * x + zy * y + zz * z;
  }
}

void ObstacleCandidates::invalidate() noexcept {
  std::fill(face_planes_.begin(), face_planes_.end(), SeenSurface());
  std::fill(queried_at_.begin(), queried_at_.end(), 0U);
  std::fill(triangles_.begin(), triangles_.end(), NearTriangles());
  mesh_clearance_.invalidate();
  nodes_.clear();
  faces_.clear();
  pairs_.clear();
}

void ObstacleCandidates::prepare(const MovingObstacle& moving, const Field3& start, const Field3& predicted) noexcept {
  ++substep_;
  toLocal(moving.before, start, start_);
  list(moving, predicted, elementReach() + kMinShare * gaps_.thickness);
}

void ObstacleCandidates::follow(const MovingObstacle& moving, const Field3& end) noexcept {
  list(moving, end, crossingReach());
}

Eigen::AlignedBox3d ObstacleCandidates::boundsWithin(double around) const noexcept {
  const Eigen::AlignedBox3d box = shape_.bounds();
  return {box.min().array() - around, box.max().array() + around};
}

void ObstacleCandidates::list(const MovingObstacle& moving, const Field3& end, double reach) noexcept {
  toLocal(moving.after, end, end_);
  for (int i = 0; i < pattern_.grid.rows; ++i) {
    row_boxes_[static_cast<std::size_t>(i)] =
        boxOfRow(start_, end_, pattern_.grid.row(i), static_cast<std::size_t>(pattern_.grid.columns));
  }
  listNodes();
  if (!elements_wanted_) return;
  if (shape_.features() != nullptr)
    listPairs(reach);
  else
    listFaces(reach);
}

// Computes a node's distance and tangent plane at the start, unless they are known.
void ObstacleCandidates::queryStart(std::size_t node) noexcept {
  if (queried_at_[node] == substep_) return;
  queried_at_[node] = substep_;
  const Vec3 at = start_.at(node);
  SeenSurface& seen = seen_[node];
  seen.at = at;
  if (const ConvexShape* convex = shape_.convex()) {
    seen.surface = convex->nearest(at);
  } else {
    const double wanted = nodeReach() + (end_.at(node) - at).norm();
    if (!query(node, at, at, wanted, seen.surface)) seen.surface = {wanted, Vec3::Zero()};
  }
  distance_[node] = seen.surface.distance;
}

bool ObstacleCandidates::isNear(std::size_t node, const Eigen::AlignedBox3d& box) noexcept {
  const double reach = nodeReach();
  const Vec3 at = start_.at(node);
  const double displacement = (end_.at(node) - at).norm();
  if (!Eigen::AlignedBox3d(at).extend(end_.at(node)).intersects(box)) return false;
  queryStart(node);
  return !(distance_[node] - displacement > reach);
}

void ObstacleCandidates::listNodes() noexcept {
  const Grid& grid = pattern_.grid;
  const Eigen::AlignedBox3d box = boundsWithin(nodeReach());
  const auto is_near = [&](int i) { return row_boxes_[static_cast<std::size_t>(i)].intersects(box); };
  workers_.run(grid.rows, [&](int i) {
    if (!is_near(i)) return;
    for (std::size_t n = grid.row(i); n < grid.index(i, grid.columns); ++n) near_[n] = isNear(n, box) ? 1 : 0;
  });
  nodes_.clear();
  for (int i = 0; i < grid.rows; ++i) {
    if (!is_near(i)) continue;
    for (std::size_t n = grid.row(i); n < grid.index(i, grid.columns); ++n) {
      if (near_[n] != 0) nodes_.push_back(static_cast<std::uint32_t>(n));
    }
  }
}

std::vector<ObstacleCandidates::NodeEnd>& ObstacleCandidates::queryEnds(double reach) noexcept {
  ends_.resize(nodes_.size());
  found_.resize(nodes_.size());
  workers_.runChunks(nodes_.size(), Workers::kSearchesAtOnce, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const std::uint32_t node = nodes_[k];
      const Vec3 from = start_.at(node), to = end_.at(node);
      ends_[k].node = node;
      const bool found =
          !isPinned(node) && !seen_[node].isClearOf(from, to, reach) && query(node, from, to, reach, ends_[k].surface);
      found_[k] = found ? 1 : 0;
    }
  });
  std::size_t count = 0;
  for (std::size_t k = 0; k < ends_.size(); ++k) {
    if (found_[k] != 0) ends_[count++] = ends_[k];
  }
  ends_.resize(count);
  return ends_;
}

}  // namespace curtain
