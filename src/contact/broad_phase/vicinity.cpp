// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/vicinity.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/link_ways.h"
#include "cloth/wide.h"
#include "contact/narrow_phase/closest_points.h"
#include "contact/shapes/shapes.h"

namespace curtain {
namespace {

// Margin for nodes to stray from their path, over the thickness: pairs with a mesh become many soon.
constexpr double kSlack = 0.25;
// A plane found within this share of the thickness tells enough of a node's distance.
constexpr double kCloseBy = 0.25;
// Nodes at this share of the thickness keep it: a tenth may lack, and what the solver leaves.
constexpr double kKept = 0.85;
// Rounding of distances, relative.
constexpr double kRounding = 1e-9;
// The expected path goes on for so many substeps at most, and no further than this over the thickness.
constexpr double kMostSubsteps = 16.0;
constexpr double kLongestWay = 0.5;
// Room for pairs with a mesh, per node of the cloth and per edge or corner of the mesh: either may be the finer one. Without room the
// cloth is held where it is, and a mesh that goes on goes through it.
constexpr std::size_t kPairsPerNode = 8;
constexpr std::size_t kPairsPerFeature = 4;

double longestEdge(const ClothPattern& pattern) {
  const Grid& grid = pattern.grid;
  double warp = 0.0, weft = 0.0;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      if (i > 0) warp = std::max(warp, pattern.warp_rest[grid.index(i, j)]);
      if (j > 0 || grid.closed) weft = std::max(weft, pattern.weft_rest[grid.index(i, j)]);
    }
  }
  return warp + weft;  // nothing holds the faces' diagonals but their sides
}

CURTAIN_WIDE double longestSquare(const Field3& p, std::size_t a, std::size_t b, std::size_t count) noexcept {
  const double *const ax = &p.x[a], *const ay = &p.y[a], *const az = &p.z[a];
  const double *const bx = &p.x[b], *const by = &p.y[b], *const bz = &p.z[b];
  double worst = 0.0;
#pragma omp simd reduction(max : worst)
  for (std::size_t n = 0; n < count; ++n) {
    const double x = bx[n] - ax[n], y = by[n] - ay[n], z = bz[n] - az[n];
    const double square = x * x + y * y + z * z;
    worst = worst > square ? worst : square;
  }
  return worst;
}

// The same as it is: links may be longer than they should.
double longestEdge(const Grid& grid, const Field3& position) noexcept {
  double warp = 0.0, weft = 0.0;
  const auto columns = static_cast<std::size_t>(grid.columns);
  for (int i = 0; i < grid.rows; ++i) {
    const std::size_t row = grid.row(i);
    if (i > 0) warp = std::max(warp, longestSquare(position, grid.row(i - 1), row, columns));
    weft = std::max(weft, longestSquare(position, row, row + 1, columns - 1));
    if (grid.closed) weft = std::max(weft, longestSquare(position, row, row + columns - 1, 1));
  }
  return std::sqrt(warp) + std::sqrt(weft);
}

// The largest square of the distance between position (as seen from place) and from + share (to - from); infinite when one is
// not finite. mass 0 is padding.
CURTAIN_WIDE double farthest(const Transform& place, const Field3& position, const Field3& from, const Field3& to, double share,
                             const Field& mass) noexcept {
  const Eigen::Matrix3d& r = place.rotation;
  const double xx = r(0, 0), xy = r(1, 0), xz = r(2, 0), yx = r(0, 1), yy = r(1, 1), yz = r(2, 1);
  const double zx = r(0, 2), zy = r(1, 2), zz = r(2, 2);
  const double tx = place.translation.x(), ty = place.translation.y(), tz = place.translation.z();
  const double *const px = position.x.data(), *const py = position.y.data(), *const pz = position.z.data();
  const double *const fx = from.x.data(), *const fy = from.y.data(), *const fz = from.z.data();
  const double *const gx = to.x.data(), *const gy = to.y.data(), *const gz = to.z.data();
  const double* const m = mass.data();
  const std::size_t size = mass.size();
  double worst = 0.0, finite = 0.0;
#pragma omp simd reduction(max : worst) reduction(+ : finite)
  for (std::size_t n = 0; n < size; ++n) {
    const double x = px[n] - tx, y = py[n] - ty, z = pz[n] - tz;
    const double dx = xx * x + xy * y + xz * z - fx[n] - share * (gx[n] - fx[n]);
    const double dy = yx * x + yy * y + yz * z - fy[n] - share * (gy[n] - fy[n]);
    const double dz = zx * x + zy * y + zz * z - fz[n] - share * (gz[n] - fz[n]);
    const double square = m[n] > 0.0 ? dx * dx + dy * dy + dz * dz : 0.0;
    worst = worst > square ? worst : square;
    finite += 0.0 * square;
  }
  return finite == 0.0 ? worst : std::numeric_limits<double>::infinity();
}

CURTAIN_WIDE void extrapolate(double factor, const Field& from, Field& to) noexcept {
  const std::size_t size = from.size();
  const double* const a = from.data();
  double* const b = to.data();
#pragma omp simd
  for (std::size_t n = 0; n < size; ++n) b[n] = a[n] + factor * (b[n] - a[n]);
}

// Smallest radius a smooth shape bends by; 0: it has edges. Infinite: it is flat.
double smoothRadius(const ObstacleShape& shape) {
  if (dynamic_cast<const PlaneShape*>(&shape) != nullptr) return std::numeric_limits<double>::infinity();
  const bool round = dynamic_cast<const SphereShape*>(&shape) != nullptr || dynamic_cast<const CapsuleShape*>(&shape) != nullptr;
  return round ? 0.5 * shape.bounds().sizes().minCoeff() : 0.0;
}

}  // namespace

Vicinity::Vicinity(const ClothPattern& pattern, const ObstacleShape& shape, double thickness, double core)
    : pattern_(pattern), shape_(shape), thickness_(thickness), core_(core), kept_(kKept * thickness),
      slack_(kSlack * thickness) {
  // Sagitta of the longest edge between two nodes that keep the thickness, less the tenth of it that they may lack.
  const double longest = longestEdge(pattern);
  const double radius = smoothRadius(shape) + 0.9 * thickness;
  const double half = 0.5 * longest;
  const double sagitta = half < radius ? radius - std::sqrt((radius - half) * (radius + half)) : radius;
  elements_wanted_ = std::isfinite(radius) && sagitta > 0.9 * thickness - core;
  const std::size_t size = pattern.grid.size(), count = pattern.grid.nodeCount();
  for (Field3* field : {&from_, &to_, &start_, &end_}) field->assign(size, 0.0);
  planes_.resize(size);
  bound_.assign(size, 0.0);
  is_taken_.assign(size, 0);
  distance_.assign(size, thickness);
  keeps_.assign(size, 1);
  taken_.reserve(count);
  nodes_.reserve(count);
  looked_at_.assign(size, 0);
  row_boxes_.resize(static_cast<std::size_t>(pattern.grid.rows));
  if (shape.convex() == nullptr) {
    pairs_.reserve(kPairsPerNode * count + kPairsPerFeature * (shape.features()->edges().size() + shape.features()->vertices().size()));
    rough_ = RoughFeatures(*shape.features(), {kOverlong * longest, kept_, core});
  } else if (elements_wanted_) {
    faces_.reserve(2 * count);
    face_planes_.resize(2 * size);
  }
}

// Nodes as seen from the obstacle.
CURTAIN_WIDE void Vicinity::toLocal(const Transform& place, const Field3& position, Field3& out) noexcept {
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

void Vicinity::forget() noexcept {
  length_ = 0.0;
  std::fill(planes_.begin(), planes_.end(), NodePlane());
  std::fill(face_planes_.begin(), face_planes_.end(), NodePlane());
  std::fill(looked_at_.begin(), looked_at_.end(), 0U);
  std::fill(is_taken_.begin(), is_taken_.end(), std::uint8_t{0});
  std::fill(distance_.begin(), distance_.end(), thickness_);
  for (auto* list : {&nodes_, &taken_}) list->clear();
  faces_.clear();
  pairs_.clear();
}

double Vicinity::strayed(const Transform& place, const Field3& position, double h) const noexcept {
  return std::sqrt(farthest(place, position, from_, to_, (elapsed_ + h) / length_, pattern_.mass));
}

void Vicinity::prepare(const MovingObstacle& moving, const Field3& start, const Field3& predicted, double h) noexcept {
  if (shape_.convex() != nullptr) {
    startConvex(moving, start);
    listConvex(moving, predicted, elementReach() + kLeast * thickness_);
    return;
  }
  const bool reaches = elapsed_ + h <= length_ * (1.0 + 1e-9);
  // Room to stray for the solve, too.
  if (!reaches || !(strayed(moving.after, predicted, h) <= 0.5 * slack_) || !(strayed(moving.before, start, 0.0) <= slack_)) {
    rebuild(moving, start, predicted, h);
    return;
  }
  takeOver(moving, start, predicted);
  if (!measureStart()) rebuild(moving, start, predicted, h);
}

void Vicinity::follow(const MovingObstacle& moving, const Field3& start, const Field3& end, double h) noexcept {
  if (shape_.convex() != nullptr) {
    listConvex(moving, end, crossingReach());
    return;
  }
  if (!(strayed(moving.after, end, h) <= slack_)) {
    rebuild(moving, start, end, h);
    return;
  }
  for (const std::uint32_t n : taken_) end_.set(n, moving.after.toLocal(end.at(n)));
}

void Vicinity::rebuild(const MovingObstacle& moving, const Field3& start, const Field3& end, double h) noexcept {
  look(moving, start, end, h);
  takeOver(moving, start, end);
  measureStart();
}

// Where listed nodes start. False: one is closer than the lists count on.
bool Vicinity::measureStart() noexcept {
  bool as_expected = true;
  for (const std::uint32_t n : nodes_) {
    const Vec3 at = start_.at(n);
    const NodePlane& plane = planes_[n];
    SurfacePoint surface;
    distance_[n] = thickness_;
    if (plane.kind != NodePlane::Kind::kUnknown && plane.lowerBound(at) >= thickness_) continue;
    if (!shape_.query(at, at, thickness_, surface)) continue;
    distance_[n] = std::min(surface.distance, thickness_);
    if (isClose(n) && keeps_[n] != 0) as_expected = false;
  }
  return as_expected;
}

void Vicinity::takeOver(const MovingObstacle& moving, const Field3& start, const Field3& end) noexcept {
  for (const std::uint32_t n : taken_) {
    start_.set(n, moving.before.toLocal(start.at(n)));
    end_.set(n, moving.after.toLocal(end.at(n)));
  }
}

// New lists.
void Vicinity::look(const MovingObstacle& moving, const Field3& start, const Field3& predicted, double h) noexcept {
  toLocal(moving.before, start, from_);
  toLocal(moving.after, predicted, to_);
  const double move = std::sqrt(farthest(moving.after, predicted, from_, from_, 0.0, pattern_.mass));
  const double most = kLongestWay * thickness_;
  // A cloth at rest goes on for ever.
  const double substeps = std::clamp(most / std::max(move, most / kMostSubsteps), 1.0, kMostSubsteps);
  length_ = substeps * h;
  elapsed_ = 0.0;
  if (substeps != 1.0) {
    extrapolate(substeps, from_.x, to_.x);
    extrapolate(substeps, from_.y, to_.y);
    extrapolate(substeps, from_.z, to_.z);
  }
  // Edges are shorter on the path than at its longer end.
  longest_ = std::max(longestEdge(pattern_.grid, from_), longestEdge(pattern_.grid, to_));
  for (const std::uint32_t n : taken_) is_taken_[n] = 0;
  taken_.clear();
  for (const std::uint32_t n : nodes_) distance_[n] = thickness_;
  full_ = false;
  lookAtNodes();
  if (elements_wanted_) lookAtElements();
}

void Vicinity::lookAtNodes() noexcept {
  nodes_.clear();
  const Grid& grid = pattern_.grid;
  const double reach = nodeReach() + slack_;
  const bool elements = elements_wanted_ && !rough_.empty();
  const double element_reach = std::max(reach, elements ? elementReach() + slack_ + longest_ : 0.0);
  const Eigen::AlignedBox3d box = shape_.bounds();
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      const Vec3 at = from_.at(n);
      const double way = (to_.at(n) - at).norm();
      NodePlane& plane = planes_[n];
      bound_[n] = std::numeric_limits<double>::infinity();
      keeps_[n] = 1;
      const double outside = (box.min() - at).cwiseMax(at - box.max()).maxCoeff();
      if (outside > element_reach + way) continue;
      double bound = plane.kind == NodePlane::Kind::kUnknown ? -1.0 : plane.lowerBound(at) - way;
      const bool close = plane.kind != NodePlane::Kind::kUnknown && bound > 0.0 && bound + way >= kept_ &&
                         (at - plane.at).squaredNorm() <= kCloseBy * kCloseBy * thickness_ * thickness_;
      if (!(bound > element_reach) && !close) {
        SurfacePoint surface;
        const double wanted = element_reach + way;
        const bool found = shape_.query(at, at, wanted, surface);
        plane.at = at;
        plane.kind = found ? NodePlane::Kind::kFound : NodePlane::Kind::kFar;
        if (found) plane.surface = surface;
        else plane.surface.distance = wanted;
        bound = plane.surface.distance - way;
        if (!found) continue;
      }
      bound_[n] = bound;
      // Nothing holds an obstacle off a pinned node.
      keeps_[n] = (isPinned(n) ? bound - slack_ : bound + way) >= kept_ * (1.0 + kRounding) ? 1 : 0;
      if (bound > reach) continue;
      const auto node = static_cast<std::uint32_t>(n);
      nodes_.push_back(node);
      takeNodes(&node, 1);
    }
  }
}

void Vicinity::takeNodes(const std::uint32_t* first, std::size_t count) noexcept {
  for (std::size_t k = 0; k < count; ++k) {
    if (is_taken_[first[k]] != 0) continue;
    is_taken_[first[k]] = 1;
    taken_.push_back(first[k]);
  }
}

void Vicinity::lookAtElements() noexcept {
  pairs_.clear();
  const Grid& grid = pattern_.grid;
  // Every point of an element is within its longest edge of any of its nodes.
  const double reach = elementReach() + slack_ + longest_;
  for (int i = 0; i + 1 < grid.rows; ++i) {
    for (int j = 0; j < grid.linkCount(); ++j) {
      const std::size_t right = static_cast<std::size_t>(j + 1 < grid.columns ? j + 1 : 0);
      const std::size_t above = grid.row(i), below = grid.row(i + 1), left = static_cast<std::size_t>(j);
      const double nearest = std::min(std::min(bound_[above + left], bound_[above + right]),
                                      std::min(bound_[below + left], bound_[below + right]));
      if (nearest > reach) continue;
      const QuadElements quad = quadElements(grid, i, j);
      bool keep = true;
      for (const std::uint32_t n : quad.corners) keep = keep && keeps_[n] != 0;
      if (!keep) addPairs(quad, *shape_.features());
      else if (!rough_.empty()) addPairs(quad, rough_);
    }
  }
}

template <typename Features>
void Vicinity::addPairs(const QuadElements& quad, const Features& features) noexcept {
  for (int k = 0; k < quad.edge_count; ++k) addEdgePairs(quad.edges[static_cast<std::size_t>(k)], features);
  for (const MeshTriangle& triangle : quad.triangles) addCornerPairs(triangle, features);
}

void Vicinity::addPair(const FeaturePair& pair) noexcept {
  full_ = full_ || pairs_.size() == pairs_.capacity();
  if (full_) return;
  pairs_.push_back(pair);
  takeNodes(pair.node.data(), pair.edges ? 2 : 3);
}

// Nodes are never further than half their way from its middle.
template <typename Features>
void Vicinity::addEdgePairs(const MeshEdge& edge, const Features& features) noexcept {
  const Vec3 a = from_.at(edge[0]), b = from_.at(edge[1]);
  const Vec3 c = to_.at(edge[0]), d = to_.at(edge[1]);
  const double reach = elementReach() + slack_;
  const double way = std::sqrt(std::max((c - a).squaredNorm(), (d - b).squaredNorm()));
  const Vec3 margin = Vec3::Constant(reach);
  const Eigen::AlignedBox3d box(a.cwiseMin(b).cwiseMin(c.cwiseMin(d)) - margin, a.cwiseMax(b).cwiseMax(c.cwiseMax(d)) + margin);
  const Vec3 p = 0.5 * (a + c), q = 0.5 * (b + d);
  const double limit = reach + 0.5 * way;
  features.forEachEdgeIn(box, [&](std::uint32_t index, const ObstacleEdge& other) {
    if (!other.touchable) return;
    // Over the plane through the edge, which is faster to tell.
    if (std::min(other.outward.dot(p - other.ends[0]), other.outward.dot(q - other.ends[0])) > limit) return;
    if (closestOnSegments(p, q, other.ends[0], other.ends[1]).distance_squared > limit * limit) return;
    addPair({{edge[0], edge[1], 0}, index, true, !rough_.isRoughEdge(index)});
  });
}

template <typename Features>
void Vicinity::addCornerPairs(const MeshTriangle& triangle, const Features& features) noexcept {
  std::array<Vec3, 3> at;
  Eigen::AlignedBox3d box;
  double way = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 now = from_.at(triangle[k]), then = to_.at(triangle[k]);
    box.extend(now);
    box.extend(then);
    at[k] = 0.5 * (now + then);
    way = std::max(way, (then - now).squaredNorm());
  }
  const double reach = elementReach() + slack_;
  box.min().array() -= reach;
  box.max().array() += reach;
  const double limit = reach + 0.5 * std::sqrt(way);
  features.forEachVertexIn(box, [&](std::uint32_t index, const ObstacleVertex& corner) {
    if (!corner.touchable) return;
    const auto height = [&](std::size_t k) { return corner.outward.dot(at[k] - corner.position); };
    if (std::min({height(0), height(1), height(2)}) > limit) return;
    if (closestOnTriangle(corner.position, at[0], at[1], at[2]).distance_squared > limit * limit) return;
    addPair({triangle, index, false, !rough_.isRoughVertex(index)});
  });
}

}  // namespace curtain
