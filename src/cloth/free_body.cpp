// SPDX-License-Identifier: BSD-3-Clause
#include "cloth/free_body.h"

#include <Eigen/Eigenvalues>

namespace curtain {
namespace {

// Principal moments below this share of the largest count as 0 (nodes on a line): no rotation about that axis.
constexpr double kMinMoment = 1e-9;

}  // namespace

RigidMotion::Displacement RigidMotion::over(double time) const noexcept {
  const double angle = time * turn.norm();
  if (!(angle > 0.0)) return {centre, time * drift, Eigen::Matrix3d::Identity()};
  return {centre, time * drift, Eigen::AngleAxisd(angle, turn.normalized()).toRotationMatrix()};
}

Vec3 turnOf(const Eigen::Matrix3d& inertia, const Vec3& spin) noexcept {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(inertia);
  const double largest = solver.eigenvalues().maxCoeff();
  Vec3 turn = Vec3::Zero();
  if (!(largest > 0.0)) return turn;
  for (int k = 0; k < 3; ++k) {
    const double moment = solver.eigenvalues()[k];
    const Vec3 axis = solver.eigenvectors().col(k);
    if (moment > kMinMoment * largest) turn += axis.dot(spin) / moment * axis;
  }
  return turn;
}

Momentum momentumOf(const ClothPattern& pattern, const Field3& position, const Field3& velocity) noexcept {
  Momentum sum;
  for (std::size_t n = 0; n < pattern.grid.size(); ++n) {
    const Vec3 p = pattern.mass[n] * velocity.at(n);
    sum.linear += p;
    sum.angular += position.at(n).cross(p);
  }
  return sum;
}

RigidMotion rigidMotion(const ClothPattern& pattern, const Field3& position, const Momentum& momentum) noexcept {
  RigidMotion motion;
  double mass = 0.0;
  for (std::size_t n = 0; n < pattern.grid.size(); ++n) {
    mass += pattern.mass[n];
    motion.centre += pattern.mass[n] * position.at(n);
  }
  motion.centre /= mass;
  motion.drift = momentum.linear / mass;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (std::size_t n = 0; n < pattern.grid.size(); ++n) {
    const Vec3 arm = position.at(n) - motion.centre;
    inertia += pattern.mass[n] * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  }
  motion.turn = turnOf(inertia, momentum.angular - motion.centre.cross(momentum.linear));
  return motion;
}

}  // namespace curtain
