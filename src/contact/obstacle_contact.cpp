// SPDX-License-Identifier: BSD-3-Clause
#include "contact/obstacle_contact.h"

#include <algorithm>

namespace curtain {
namespace {

// Planes kept per node of the grid: a node may touch so many obstacles at once all over the cloth.
constexpr std::size_t kPerNode = 4;
// A node that is too close when the substep starts (an obstacle appeared there or jumped) is brought out at these speeds
// [m/s], not at once: the way out must not become a blow. Inside the obstacle, and inside the gap around it.
constexpr double kRecoverySpeed = 2.0;
constexpr double kGapRecoverySpeed = 0.1;

// Substeps without friction after one whose links could not be brought to their lengths.
constexpr int kSlipperySubsteps = 64;

// Box around the way of all free nodes.
Eigen::AlignedBox3d sweptBox(const ClothPattern& pattern, const Field3& start, const Field3& predicted) {
  Eigen::AlignedBox3d box;
  const Grid& grid = pattern.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      box.extend(start.at(grid.index(i, j)));
      box.extend(predicted.at(grid.index(i, j)));
    }
  }
  return box;
}

}  // namespace

ObstacleContact::ObstacleContact(const ClothPattern& pattern, const ContactParams& params, const ObstacleSet& obstacles)
    : thickness_(params.thickness),
      obstacles_(obstacles),
      capacity_(pattern.grid.nodeCount() * std::min<std::size_t>(kPerNode, static_cast<std::size_t>(obstacles.count()))) {
  planes_.reserve(capacity_);
}

bool ObstacleContact::begin(const ClothPattern& pattern, const Field3& start, const Field3& predicted, double h) noexcept {
  planes_.clear();
  const std::vector<MovingObstacle>& moving = obstacles_.moving();
  if (moving.empty()) return false;
  const Eigen::AlignedBox3d cloth = sweptBox(pattern, start, predicted);
  // The solve may move nodes beyond their predicted way by about as much again.
  const double reach = 2.0 * thickness_ + 0.25 * cloth.diagonal().norm() / pattern.grid.rows;
  for (std::size_t n = 0; n < moving.size(); ++n) {
    if (!moving[n].present) continue;
    Eigen::AlignedBox3d box = moving[n].sweptBounds();
    box.min().array() -= reach;
    box.max().array() += reach;
    if (box.intersects(cloth)) collect(pattern, start, predicted, h, static_cast<int>(n), box);
  }
  return !planes_.empty();
}

void ObstacleContact::collect(const ClothPattern& pattern, const Field3& start, const Field3& predicted, double h,
                              int obstacle, const Eigen::AlignedBox3d& box) noexcept {
  const Grid& grid = pattern.grid;
  const MovingObstacle& moving = obstacles_.moving()[static_cast<std::size_t>(obstacle)];
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t node = grid.index(i, j);
      if (pattern.inverse_mass[node] <= 0.0) continue;
      const Vec3 from = start.at(node);
      const Vec3 to = predicted.at(node);
      if (!box.intersects(Eigen::AlignedBox3d(from.cwiseMin(to), from.cwiseMax(to)))) continue;
      SurfacePoint surface;
      const Vec3 local_from = moving.before.toLocal(from);
      const double reach = 2.0 * thickness_ + (to - from).norm();
      if (!moving.shape->query(local_from, moving.after.toLocal(to), reach, surface)) continue;
      if (planes_.size() == capacity_) {
        ++overflow_;
        return;
      }
      Plane plane;
      plane.node = node;
      plane.obstacle = obstacle;
      plane.normal = moving.after.rotation * surface.normal;
      plane.offset = plane.normal.dot(to) - surface.distance + thickness_;
      SurfacePoint before;
      if (moving.shape->query(local_from, local_from, thickness_, before)) {
        const double speed = before.distance < 0.0 ? kRecoverySpeed : kGapRecoverySpeed;
        plane.offset -= std::max(0.0, thickness_ - before.distance - speed * h);
        // Nothing holds a node back on its way out: friction there could lock cloth around an edge for good.
        if (before.distance < 0.0) plane.friction = 0.0;
      }
      plane.carried = moving.after.toWorld(local_from);
      plane.surface_velocity = (plane.carried - from) / h;
      plane.friction = slippery_ > 0 ? 0.0 : moving.friction;
      planes_.push_back(plane);
    }
  }
}

// Both multipliers are accumulated over the sweeps, so that what a plane pushed too far in one it takes back in another,
// and friction always answers the whole push.
double ObstacleContact::project(Field3& position) noexcept {
  double largest = 0.0;
  for (Plane& plane : planes_) {
    Vec3 x = position.at(plane.node);
    const double push = std::max(0.0, plane.push + plane.offset - plane.normal.dot(x));
    const double change = push - plane.push;
    plane.push = push;
    Vec3 move = change * plane.normal;
    x += move;
    if (push > 0.0 || plane.slide_back.squaredNorm() > 0.0) {
      // Coulomb: friction holds the node to the surface with at most friction * push.
      Vec3 slip = x - plane.carried;
      slip -= plane.normal.dot(slip) * plane.normal;
      Vec3 wanted = plane.slide_back - slip;
      const double most = plane.friction * push;
      const double size = wanted.norm();
      if (size > most) wanted *= most / size;
      const Vec3 slide = wanted - plane.slide_back;
      plane.slide_back = wanted;
      x += slide;
      move += slide;
    }
    largest = std::max(largest, move.squaredNorm());
    position.set(plane.node, x);
  }
  return std::sqrt(largest);
}

void ObstacleContact::projectVelocity(Field3& velocity) noexcept {
  for (const Plane& plane : planes_) {
    if (plane.push <= 0.0) continue;
    const Vec3 v = velocity.at(plane.node);
    const double approach = (v - plane.surface_velocity).dot(plane.normal);
    if (approach < 0.0) velocity.set(plane.node, v - approach * plane.normal);
  }
}

void ObstacleContact::afterSubstep(bool settled) noexcept {
  if (!settled) slippery_ = kSlipperySubsteps;
  else if (slippery_ > 0) --slippery_;
}

int ObstacleContact::contactCount() const noexcept {
  return static_cast<int>(std::count_if(planes_.begin(), planes_.end(), [](const Plane& p) { return p.push > 0.0; }));
}

double ObstacleContact::deepestPenetration(const Field3& position) const noexcept {
  double deepest = 0.0;
  for (const Plane& plane : planes_) {
    const MovingObstacle& moving = obstacles_.moving()[static_cast<std::size_t>(plane.obstacle)];
    const Vec3 local = moving.after.toLocal(position.at(plane.node));
    SurfacePoint surface;
    if (moving.shape->query(local, local, 0.0, surface)) deepest = std::max(deepest, -surface.distance);
  }
  return deepest;
}

void ObstacleContact::addForces(const Field& inverse_inertia, double scale, Field3& force) const noexcept {
  for (const Plane& plane : planes_) {
    force.add(plane.node, (plane.push * plane.normal + plane.slide_back) / (inverse_inertia[plane.node] * scale));
  }
}

}  // namespace curtain
