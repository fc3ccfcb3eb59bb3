// SPDX-License-Identifier: BSD-3-Clause
#include "forces/drag_force.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace curtain {
namespace {

// A pulled node takes about a quarter of the cloth along; the spring is critically damped for that mass.
constexpr double kDraggedShare = 0.25;

}  // namespace

NodeIndex nearestNode(const Grid& grid, const Field3& position, const Vec3& point) noexcept {
  NodeIndex nearest;
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const double distance = (position.at(grid.index(i, j)) - point).squaredNorm();
      if (distance < best) {
        best = distance;
        nearest = {i, j};
      }
    }
  }
  return nearest;
}

DragForce::DragForce(const DragParams& drag, const ClothPattern& pattern) : drag_(drag) {
  shares_.reserve(drag.radius > 0.0 ? pattern.grid.nodeCount() : 1);
  const double total_mass = std::accumulate(pattern.mass.begin(), pattern.mass.end(), 0.0);
  spring_damping_ = 2.0 * std::sqrt(drag.stiffness * kDraggedShare * total_mass);
  if (drag.node) grasp(*drag.node, pattern);
}

void DragForce::grasp(NodeIndex node, const ClothPattern& pattern) noexcept {
  node_ = node;
  shares_.clear();
  const Grid& grid = pattern.grid;
  if (drag_.radius <= 0.0) {
    shares_.push_back({grid.index(node), 1.0});
  } else {
    const double v = pattern.warp_coordinate[static_cast<std::size_t>(node.row)];
    const double u = pattern.weft_coordinate[static_cast<std::size_t>(node.column)];
    const double ring = grid.closed ? pattern.weft_coordinate.back() + pattern.weft_rest[0] : 0.0;
    double sum = 0.0;
    for (int i = 0; i < grid.rows; ++i) {
      for (int j = 0; j < grid.columns; ++j) {
        const double dv = pattern.warp_coordinate[static_cast<std::size_t>(i)] - v;
        double du = std::abs(pattern.weft_coordinate[static_cast<std::size_t>(j)] - u);
        if (grid.closed) du = std::min(du, ring - du);
        const double near = 1.0 - (du * du + dv * dv) / (drag_.radius * drag_.radius);
        if (near <= 0.0) continue;
        shares_.push_back({grid.index(i, j), near * near});
        sum += near * near;
      }
    }
    for (Share& share : shares_) share.weight /= sum;
  }
  grasp_inverse_mass_ = 0.0;
  for (const Share& share : shares_) {
    grasp_inverse_mass_ += share.weight * share.weight * pattern.inverse_mass[share.node];
  }
}

// Implicit Euler for the grasped nodes alone: v' = v + dt W F with F = k (target - x - dt v') - c v'. The rest of the
// cloth only makes them heavier, hence steadier.
Vec3 DragForce::springForce(const Field3& position, const Field3& velocity, double dt) const noexcept {
  Vec3 x = Vec3::Zero();
  Vec3 v = Vec3::Zero();
  for (const Share& share : shares_) {
    x += share.weight * position.at(share.node);
    v += share.weight * velocity.at(share.node);
  }
  const double k = drag_.stiffness;
  const double c = spring_damping_;
  Vec3 pull = (k * (*drag_.target - x) - (c + k * dt) * v) / (1.0 + grasp_inverse_mass_ * dt * (c + k * dt));
  const double size = pull.norm();
  if (size > drag_.max_force) pull *= drag_.max_force / size;
  return pull;
}

void DragForce::addForces(const ClothPattern& pattern, const Field3& position, const Field3& velocity, double dt,
                          Field3& force) noexcept {
  if (!node_) grasp(nearestNode(pattern.grid, position, *drag_.point), pattern);
  const Vec3 pull = drag_.target ? springForce(position, velocity, dt) : drag_.force;
  for (const Share& share : shares_) force.add(share.node, share.weight * pull);
}

}  // namespace curtain
