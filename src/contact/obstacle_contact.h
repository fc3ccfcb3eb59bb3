// SPDX-License-Identifier: BSD-3-Clause
//
// Contact of first-layer nodes with obstacles, solved together with the links: every node that may touch within the
// substep gets a one-sided plane, tangent to the obstacle and a thickness away, with Coulomb friction against the moving
// surface. Inelastic.
#pragma once

#include <cstdint>
#include <vector>

#include "contact/obstacle_set.h"
#include "solver/substep.h"

namespace curtain {

class ObstacleContact : public PositionConstraints {
 public:
  /// obstacles must outlive this.
  ObstacleContact(const ClothPattern& pattern, const ContactParams& params, const ObstacleSet& obstacles);

  bool begin(const ClothPattern& pattern, const Field3& start, const Field3& predicted, double h) noexcept override;
  double project(Field3& position) noexcept override;
  void projectVelocity(Field3& velocity) noexcept override;

  /// Candidates of the last substep: nothing is near when false.
  bool any() const { return !planes_.empty(); }
  /// Nodes pressed on in the last substep.
  int contactCount() const noexcept;
  /// How deep the deepest node is inside an obstacle [m]; 0: none is.
  double deepestPenetration(const Field3& position) const noexcept;
  /// Adds the contact forces of the last substep [N]; inverse_inertia: how its nodes answered [1/kg], scale: its
  /// h * kick [s^2].
  void addForces(const Field& inverse_inertia, double scale, Field3& force) const noexcept;
  /// Substeps in which a contact found no room (more than kPerNode obstacles at one node, everywhere).
  std::int64_t overflowCount() const { return overflow_; }
  void forget() noexcept {
    planes_.clear();
    slippery_ = 0;
  }
  /// After every substep: whether the links could be brought to their lengths. Where they could not, cloth is locked on
  /// something; friction is left out for the next substeps, so that it can slip off.
  void afterSubstep(bool settled) noexcept;

 private:
  struct Plane {
    std::size_t node;
    int obstacle;
    Vec3 normal;         // away from the obstacle
    double offset;       // the node must keep normal . x >= offset
    Vec3 surface_velocity;  // [m/s], of the surface under the node
    Vec3 carried;        // where the surface under the node's start has gone by the end of the substep
    double friction;
    double push = 0.0;   // how far the plane has pushed the node [m], >= 0
    Vec3 slide_back = Vec3::Zero();  // how far friction has [m], across the normal
  };
  void collect(const ClothPattern& pattern, const Field3& start, const Field3& predicted, double h, int obstacle,
               const Eigen::AlignedBox3d& box) noexcept;

  double thickness_;
  const ObstacleSet& obstacles_;
  std::vector<Plane> planes_;  // room is reserved at construction
  std::size_t capacity_;
  std::int64_t overflow_ = 0;
  int slippery_ = 0;  // substeps still to go without friction
};

}  // namespace curtain
