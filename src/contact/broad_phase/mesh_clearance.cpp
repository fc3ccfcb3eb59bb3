// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/mesh_clearance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cloth/wide.h"
#include "obstacles/obstacle_features.h"

namespace curtain {
namespace {

// Radius of a new window over the least that would do: larger ones last longer and hold more features.
constexpr double kMargin = 1.5;

struct FaceWindows {
  ConstFieldView centre, normal;
  const double *radius, *top;
};

// Extent of one quad's corners relative to its window, so far.
struct Extent {
  double away = 0.0, low = std::numeric_limits<double>::infinity(), sum = 0.0;
};

CURTAIN_INTO_WIDE void extend(const FaceWindows& w, const ConstFieldView& p, std::size_t q, Extent& extent) {
  const double x = p.x[q] - w.centre.x[q], y = p.y[q] - w.centre.y[q], z = p.z[q] - w.centre.z[q];
  const double square = x * x + y * y + z * z;
  const double height = w.normal.x[q] * x + w.normal.y[q] * y + w.normal.z[q] * z;
  extent.away = extent.away > square ? extent.away : square;
  extent.low = extent.low < height ? extent.low : height;
  extent.sum += square;
}

// Classifies quads side by side, given their four corners at the start and at the end.
CURTAIN_WIDE void classifyAll(const FaceWindows& w, const std::array<ConstFieldView, 8>& corners, double reach,
                              std::size_t count, QuadClearance* views) noexcept {
#pragma omp simd
  for (std::size_t q = 0; q < count; ++q) {
    Extent extent;
    for (std::size_t k = 0; k < 8; ++k) extend(w, corners[k], q, extent);
    const double room = w.radius[q] - reach;
    // The sum is finite only if every corner is.
    const bool stays = room > 0.0 && extent.away < room * room && extent.sum - extent.sum == 0.0;
    const bool is_over = extent.low > w.top[q] + reach;
    views[q] = static_cast<QuadClearance>(stays ? (is_over ? 1 : 2) : 0);
  }
}

// Largest normal . (x - centre) of the part of the edge in the ball; -infinity: the edge does not reach it.
double highestInBall(const ObstacleEdge& edge, const Vec3& centre, double radius, const Vec3& normal) {
  const Vec3 from = edge.ends[0] - centre, along = edge.ends[1] - edge.ends[0];
  // Where the line is at the radius: |from + t along| = radius.
  const double a = along.squaredNorm(), b = from.dot(along), c = from.squaredNorm() - radius * radius;
  const double root = b * b - a * c;
  if (!(root >= 0.0)) return -std::numeric_limits<double>::infinity();
  const double first = std::max(0.0, (-b - std::sqrt(root)) / a), last = std::min(1.0, (-b + std::sqrt(root)) / a);
  if (first > last) return -std::numeric_limits<double>::infinity();
  const double low = normal.dot(from), slope = normal.dot(along);
  return low + std::max(first * slope, last * slope);
}

}  // namespace

SweptQuad::SweptQuad(const QuadElements& quad, const Field3& start, const Field3& end) noexcept {
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint32_t n = quad.corners[k];
    x_[k] = start.x[n], y_[k] = start.y[n], z_[k] = start.z[n];
    x_[k + 4] = end.x[n], y_[k + 4] = end.y[n], z_[k + 4] = end.z[n];
  }
}

Vec3 SweptQuad::middle() const noexcept {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < 8; ++k) sum += Vec3(x_[k], y_[k], z_[k]);
  return 0.125 * sum;
}

double SweptQuad::furthest(const Vec3& from) const noexcept {
  double square = 0.0;
  for (std::size_t k = 0; k < 8; ++k) square = std::max(square, (Vec3(x_[k], y_[k], z_[k]) - from).squaredNorm());
  return std::sqrt(square);
}

double SweptQuad::lowest(const Vec3& normal, const Vec3& from) const noexcept {
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 8; ++k) {
    const double height =
        normal.x() * (x_[k] - from.x()) + normal.y() * (y_[k] - from.y()) + normal.z() * (z_[k] - from.z());
    lowest = lowest < height ? lowest : height;
  }
  return lowest;
}

// When the list is full the lowest feature is dropped, and `rest` bounds it.
void MeshClearance::HighestFeatures::insert(double height, std::uint32_t feature) noexcept {
  std::size_t k = count;
  if (count < kMost) {
    ++count;
  } else {
    --k;
    rest = std::max(rest, std::min(height, heights[k]));
    if (height <= heights[k]) return;
  }
  for (; k > 0 && heights[k - 1] < height; --k) {
    heights[k] = heights[k - 1];
    features[k] = features[k - 1];
  }
  heights[k] = height;
  features[k] = feature;
}

MeshClearance::MeshClearance(const Grid& grid, const ContactShape& mesh) : grid_(grid), mesh_(&mesh) {
  for (Field3* field : {&centre_, &normal_}) field->assign(grid.size(), 0.0);
  radius_.assign(grid.size(), -1.0);
  top_.assign(grid.size(), 0.0);
  highest_.resize(grid.size());
  clearances_.assign(grid.size(), QuadClearance::kUnknown);
}

void MeshClearance::invalidate() noexcept { std::fill(radius_.begin(), radius_.end(), -1.0); }

const QuadClearance* MeshClearance::classify(int row, const Field3& start, const Field3& end, double reach) noexcept {
  const auto columns = static_cast<std::size_t>(grid_.columns);
  const std::size_t above = grid_.row(row), below = grid_.row(row + 1);
  const auto classifyFrom = [&](std::size_t left, std::size_t right, std::size_t count) {
    const std::size_t n = above + left;
    const FaceWindows windows{{centre_, n}, {normal_, n}, &radius_[n], &top_[n]};
    classifyAll(windows,
                {{{start, n},
                  {start, above + right},
                  {start, below + left},
                  {start, below + right},
                  {end, n},
                  {end, above + right},
                  {end, below + left},
                  {end, below + right}}},
                reach, count, &clearances_[n]);
  };
  classifyFrom(0, 1, columns - 1);
  if (grid_.closed) classifyFrom(columns - 1, 0, 1);
  return &clearances_[above];
}

QuadClearance MeshClearance::rebuild(const QuadElements& quad, const SweptQuad& swept, double reach) noexcept {
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  const std::size_t window = quad.corners[0];
  const Vec3 centre = swept.middle();
  const double radius = kMargin * (swept.furthest(centre) + reach);
  const Eigen::AlignedBox3d box(centre.array() - radius, centre.array() + radius);
  SurfacePoint surface;
  const Vec3 normal = mesh_->query(centre, centre, radius, surface) ? surface.normal : Vec3::Zero();
  HighestFeatures& highest = highest_[window];
  highest.count = 0;
  highest.rest = kNone;
  mesh_->features()->forEachEdgeIn(box, [&](std::uint32_t index, const ObstacleEdge& edge) {
    if (!edge.touchable) return;
    const double height = highestInBall(edge, centre, radius, normal);
    if (height > kNone) highest.insert(height, index);
  });
  mesh_->features()->forEachVertexIn(box, [&](std::uint32_t index, const ObstacleVertex& corner) {
    const Vec3 at = corner.position - centre;
    if (corner.touchable && at.squaredNorm() <= radius * radius) highest.insert(normal.dot(at), index | kCorner);
  });
  centre_.set(window, centre);
  normal_.set(window, normal);
  radius_[window] = radius;
  top_[window] = highest.count > 0 ? highest.heights[0] : kNone;
  return swept.lowest(normal, centre) > top_[window] + reach ? QuadClearance::kClear : QuadClearance::kNear;
}

}  // namespace curtain
