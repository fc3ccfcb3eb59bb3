// SPDX-License-Identifier: BSD-3-Clause
#include "contact/response/exit_direction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace curtain {
namespace {

constexpr double kAlike = 0.9;  // cosine above which two directions count as one
constexpr int kHalvings = 10;   // bisection steps: to a thousandth of the path, and the next substep repeats it

}  // namespace

ExitDirection::Part ExitDirection::partOf(std::uint32_t node) const noexcept {
  const auto stride = static_cast<std::size_t>(grid_.stride);
  const int i = static_cast<int>(node / stride), j = static_cast<int>(node % stride);
  const auto beside = [&](int row, int column) {
    const int around =
        grid_.closed ? (column + grid_.columns) % grid_.columns : std::clamp(column, 0, grid_.columns - 1);
    return static_cast<std::uint32_t>(grid_.index(std::clamp(row, 0, grid_.rows - 1), around));
  };
  const std::uint32_t left = beside(i, j - 1), right = beside(i, j + 1), above = beside(i - 1, j),
                      below = beside(i + 1, j);
  const auto at = [&](std::uint32_t n) { return candidates_.startOf(n); };
  return {at(node), (at(right) - at(left)).cross(at(below) - at(above)), {left, right, above, below}, 4};
}

ExitDirection::Part ExitDirection::partOf(const PenetratingFace& face) const noexcept {
  const Vec3 a = candidates_.startOf(face.node[0]), b = candidates_.startOf(face.node[1]),
             c = candidates_.startOf(face.node[2]);
  const auto& weight = face.deepest.weights;
  // A quad's triangles are (upper left, lower left, upper right) and (upper right, lower left, lower right).
  return {weight[0] * a + weight[1] * b + weight[2] * c,
          (c - a).cross(b - a),
          {face.node[0], face.node[1], face.node[2], 0},
          3};
}

template <typename F>
void ExitDirection::forEachPart(const F& f) const noexcept {
  for (const std::uint32_t node : candidates_.nodes()) {
    if (isInside(node)) f(partOf(node));
  }
  for (const PenetratingFace& face : faces_) f(partOf(face));
}

// Directions that pull no cloth through the obstacle come first; among them the one with the shortest path for the
// deepest part.
ExitDirection::ExitDirection(const Grid& grid, const ObstacleCandidates& candidates,
                             const std::vector<PenetratingFace>& faces) noexcept
    : grid_(grid), candidates_(candidates), faces_(faces), shape_(candidates.shape().convex()) {
  if (shape_ == nullptr) return;
  forEachPart([&](const Part& part) { addDirection(shape_->nearest(part.at).normal); });
  if (count_ == 0) return;
  const Vec3 across = clothNormal();
  for (const double side : {1.0, -1.0}) {
    if (!across.isZero(0.0)) addDirection(side * across);
  }
  if (count_ < 2) return;
  auto best = std::tuple(true, std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < count_; ++k) {
    const auto cost = std::tuple(pullsClothThrough(directions_[k]), depthAlong(directions_[k]));
    if (!(cost < best)) continue;
    best = cost;
    normal_ = directions_[k];
    any_ = true;
  }
}

SurfacePoint ExitDirection::exitSurface(const Vec3& from, const SurfacePoint& own) const noexcept {
  if (!any_ || own.normal.dot(normal_) >= kSameSide) return own;
  SurfacePoint common;
  common.normal = normal_;
  common.distance = -exitDistance(from, normal_);
  return common;
}

void ExitDirection::addDirection(const Vec3& normal) noexcept {
  for (std::size_t k = 0; k < count_; ++k) {
    if (directions_[k].dot(normal) > kAlike) return;
  }
  if (count_ < kMost) directions_[count_++] = normal;
}

// Mean normal of the cloth inside; zero: it cancels.
Vec3 ExitDirection::clothNormal() const noexcept {
  Vec3 sum = Vec3::Zero();
  forEachPart([&](const Part& part) { sum += part.across.normalized(); });
  const double size = sum.norm();
  return size > 0.0 ? Vec3(sum / size) : Vec3::Zero();
}

// A neighbour of a part inside is beyond the far side.
bool ExitDirection::pullsClothThrough(const Vec3& normal) const noexcept {
  const double far_side = shape_->support(-normal);
  bool draws = false;
  forEachPart([&](const Part& part) {
    for (std::size_t k = 0; k < part.joined_count; ++k) {
      const std::uint32_t node = part.joined[k];
      draws = draws || (!isInside(node) && -normal.dot(candidates_.startOf(node)) > far_side);
    }
  });
  return draws;
}

double ExitDirection::depthAlong(const Vec3& normal) const noexcept {
  double deepest = 0.0;
  forEachPart([&](const Part& part) { deepest = std::max(deepest, exitDistance(part.at, normal)); });
  return deepest;
}

// Distance to the exit along a direction; infinite: none. Bisection between the point and the supporting plane: a
// convex shape is left once.
double ExitDirection::exitDistance(const Vec3& from, const Vec3& direction) const noexcept {
  double out = shape_->support(direction) - direction.dot(from), in = 0.0;
  for (int halving = 0; halving < kHalvings && std::isfinite(out); ++halving) {
    const double middle = 0.5 * (in + out);
    (shape_->nearest(from + middle * direction).distance < 0.0 ? in : out) = middle;
  }
  return out;
}

}  // namespace curtain
