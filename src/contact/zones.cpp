// SPDX-License-Identifier: BSD-3-Clause
#include "contact/zones.h"

#include <Eigen/Eigenvalues>

namespace curtain {
namespace {

// Principal moments below this share of the largest are those of nodes on a line: nothing turns about it.
constexpr double kLeastMoment = 1e-9;

// theta with inertia theta = spin, as far as there is inertia.
Vec3 turnOf(const Eigen::Matrix3d& inertia, const Vec3& spin) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(inertia);
  const double largest = solver.eigenvalues().maxCoeff();
  Vec3 turn = Vec3::Zero();
  if (!(largest > 0.0)) return turn;
  for (int k = 0; k < 3; ++k) {
    const double moment = solver.eigenvalues()[k];
    const Vec3 axis = solver.eigenvectors().col(k);
    if (moment > kLeastMoment * largest) turn += axis.dot(spin) / moment * axis;
  }
  return turn;
}

}  // namespace

Zones::Zones(const ClothPattern& pattern) : pattern_(pattern), parent_(pattern.grid.size(), kAlone), body_(pattern.grid.size(), 0) {
  members_.reserve(pattern.grid.nodeCount());
  bodies_.reserve(pattern.grid.nodeCount() / 2 + 1);
}

void Zones::clear() noexcept {
  for (const std::uint32_t node : members_) parent_[node] = kAlone;
  members_.clear();
}

std::uint32_t Zones::find(std::uint32_t node) noexcept {
  while (parent_[node] != node) {
    parent_[node] = parent_[parent_[node]];
    node = parent_[node];
  }
  return node;
}

std::uint32_t Zones::enter(std::size_t at) noexcept {
  const auto node = static_cast<std::uint32_t>(at);
  if (parent_[node] == kAlone) {
    parent_[node] = node;
    members_.push_back(node);
  }
  return find(node);
}

void Zones::join(std::size_t a, std::size_t b) noexcept {
  const std::uint32_t root_a = enter(a), root_b = enter(b);
  if (root_a != root_b) parent_[root_b] = root_a;
}

void Zones::makeRigid(const Field3& start, Field3& end) noexcept {
  bodies_.clear();
  for (const std::uint32_t node : members_) {
    if (find(node) != node) continue;
    body_[node] = static_cast<std::uint32_t>(bodies_.size());
    bodies_.emplace_back();
  }
  for (const std::uint32_t node : members_) {
    Body& body = bodyOf(node);
    const double mass = pattern_.mass[node];
    body.held = body.held || pattern_.inverse_mass[node] <= 0.0;
    body.mass += mass;
    body.centre += mass * start.at(node);
    body.move += mass * (end.at(node) - start.at(node));
  }
  for (Body& body : bodies_) {
    body.centre /= body.mass;
    body.move /= body.mass;
  }
  for (const std::uint32_t node : members_) {
    Body& body = bodyOf(node);
    const double mass = pattern_.mass[node];
    const Vec3 arm = start.at(node) - body.centre;
    body.spin += mass * arm.cross(end.at(node) - start.at(node));
    body.inertia += mass * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  }
  for (Body& body : bodies_) body.turn = body.held ? Vec3(Vec3::Zero()) : turnOf(body.inertia, body.spin);
  for (const std::uint32_t node : members_) {
    const Body& body = bodyOf(node);
    const Vec3 from = start.at(node);
    end.set(node, body.held ? from : Vec3(from + body.move + body.turn.cross(from - body.centre)));
  }
}

void Zones::stop(const Field3& start, Field3& end) const noexcept {
  for (const std::uint32_t node : members_) end.set(node, start.at(node));
}

}  // namespace curtain
