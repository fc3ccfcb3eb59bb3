// SPDX-License-Identifier: BSD-3-Clause
//
// The last resort: a substep that ends within bounds whatever acts.
//
//   cut    before the solve: no node is predicted to move further than `reach` times its shortest link, relative to the
//          rigid motion of the pins (without pins: of the cloth). In the limit of reach 0 there is nothing to solve.
//   bound  after it: the cloth moves along the straight path to the solution only as far as every link is within its
//          bound. A length is a convex function along the path, so a link within its bound at the start leaves it at
//          most once. If the path is free of contact, so is its beginning.
//
// The momentum that is lost is counted.
#pragma once

#include "cloth/free_body.h"
#include "step/distance_rows.h"
#include "step/scheme.h"

namespace curtain {

/// Not thread-safe. Allocates only in the constructor.
class LastResort final : public Scheme {
 public:
  /// pattern and distances must outlive this.
  LastResort(const ClothPattern& pattern, const DistanceRows& distances);

  SubstepStart start(const Task& task, const ClothState& state, SubstepOutcome& outcome) noexcept override;

  /// Cuts the velocities [m/s] of a substep of h [s] from `position` [m]; nodes with inverse inertia 0 keep theirs.
  /// Returns the momentum taken out [N s].
  double cut(const Field3& position, const Field& inverse, double h, double reach, Field3& velocity) noexcept;

  /// After cut(): moves `end` back along the path until every link with a movable end is within `allowed` (relative
  /// overlength; rods also underlength), or within the largest violation at the start of the path. Where that is far
  /// larger, any end is accepted that is not much worse. Returns the share of the path that is left, and mass times
  /// path of the rest, summed over the nodes [kg m].
  struct Bound {
    double share = 1.0;
    double moment = 0.0;
  };
  Bound bound(const Field& inverse, double allowed, Field3& end) noexcept;

  /// After cut(): a pin moves.
  bool pinsMove() const noexcept { return pins_move_; }
  /// After cut(): start of the path, where nodes follow the pins' rigid motion [m].
  const Field3& follows() const noexcept { return follows_; }

 private:
  bool rigidMotionOfPins(const Field3& position, const Field& inverse, const Field3& velocity,
                         RigidMotion& motion) const noexcept;
  template <typename Visit>
  void forEachBound(const Field& inverse, const Visit& visit) const;
  struct Misfit {
    double worst = 0.0, squares = 0.0;
  };
  Misfit misfitOf(const Field3& position, const Field& inverse) const noexcept;
  double shareOf(std::size_t a, std::size_t b, double rest, bool rod, double allowed, double most,
                 const Field3& end) const noexcept;

  const ClothPattern& pattern_;
  const DistanceRows& distances_;
  bool pins_move_ = false;
  ClothState base_;  // positions, and velocities after the forces and the cut
  Field3 no_force_;
  Field shortest_;  // link or line at each node [m]
  Field3 follows_;  // where the pins' rigid motion leads; without pins: the nodes' positions [m]
};

}  // namespace curtain
