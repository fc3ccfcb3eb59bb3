// SPDX-License-Identifier: BSD-3-Clause
#include "parts/drag/drag_force.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace curtain {
namespace {

// Share of the cloth's mass that a dragged node moves with it; the spring is critically damped for that mass.
constexpr double kDraggedShare = 0.25;

ScriptedMotion motionAlong(const std::vector<PointKey>& path) {
  std::vector<PoseKey> poses;
  for (const PointKey& point : path) poses.push_back({point.time, {point.position, Rotation::Identity()}});
  return {Pose(), poses, 0.0};
}

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

DragForce::DragForce(const DragParams& drag, const ClothPattern& pattern) : drag_(drag), path_(motionAlong(drag.path)) {
  shares_.reserve(drag.radius > 0.0 ? pattern.grid.nodeCount() : 1);
  const double total_mass = std::accumulate(pattern.mass.begin(), pattern.mass.end(), 0.0);
  spring_damping_ = 2.0 * std::sqrt(drag.stiffness * kDraggedShare * total_mass);
  if (drag.node) grasp(*drag.node, pattern);
}

void DragForce::grasp(NodeIndex node, const ClothPattern& pattern) noexcept {
  node_ = node;
  shares_.clear();
  const Grid& grid = pattern.grid;
  if (!(drag_.radius * drag_.radius > 0.0)) {  // also where the square underflows
    shares_.push_back({grid.index(node), 1.0});
  } else {
    const double v = pattern.warp_coordinate[grid.index(node)];
    const double u = pattern.weft_coordinate[static_cast<std::size_t>(node.column)];
    const double ring = grid.closed ? pattern.weft_coordinate.back() + pattern.weft_rest[0] : 0.0;
    double sum = 0.0;
    for (int i = 0; i < grid.rows; ++i) {
      for (int j = 0; j < grid.columns; ++j) {
        if (pattern.layer[static_cast<std::size_t>(j)] != pattern.layer[static_cast<std::size_t>(node.column)])
          continue;
        const double dv = pattern.warp_coordinate[grid.index(i, j)] - v;
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
}

// The spring's present pull. Its damper, and the implicit term that makes it stable at any stiffness (backward Euler: k
// (target - x - dt v')), are damping coefficients: the solver puts them into the nodes' inertia, so the links feel them
// too. At its force limit the spring is a softer one. On a path the damper is between node and target.
void DragForce::addSpring(const Field3& position, double end, double dt, Field3& force, Field& damping) const noexcept {
  Vec3 x = Vec3::Zero();
  for (const Share& share : shares_) x += share.weight * position.at(share.node);
  const Vec3 way = (path_.any() ? path_.at(end).position : *drag_.target) - x;
  const double distance = way.norm();
  const double k = distance * drag_.stiffness > drag_.max_force ? drag_.max_force / distance : drag_.stiffness;
  // At the limit no more of the damper leads the node.
  const Vec3 led = path_.any() ? Vec3(k / drag_.stiffness * spring_damping_ * path_.rateAt(end).move) : Vec3::Zero();
  for (const Share& share : shares_) {
    force.add(share.node, (share.weight * k) * way + share.weight * led);
    damping[share.node] += share.weight * (spring_damping_ + k * dt);
  }
}

void DragForce::addForces(const ClothPattern& pattern, const Field3& position, double end, double dt, Field3& force,
                          Field& damping) noexcept {
  if (!node_) grasp(nearestNode(pattern.grid, position, *drag_.point), pattern);
  if (damps()) {
    addSpring(position, end, dt, force, damping);
  } else {
    for (const Share& share : shares_) force.add(share.node, share.weight * drag_.force);
  }
}

}  // namespace curtain
