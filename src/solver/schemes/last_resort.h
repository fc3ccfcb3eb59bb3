// SPDX-License-Identifier: BSD-3-Clause
//
// The last resort: a substep that ends well whatever acts. Two bounds make it so.
//
//   cut    before the solve: no node is predicted to move further than `reach` of its shortest link, relative to the
//          rigid motion of the pins (of the cloth itself where nothing is pinned). In the limit of reach 0 nothing is
//          left to solve.
//   share  after it: the cloth goes along the straight path from where it follows its pins to what was solved only as
//          far as every link is within its bound. A length along a straight path is a convex function of the share, so
//          a link within its bound at the start leaves it once at most. The path's prefix is free of contact if the
//          path is.
//
// What the bounds take is momentum; it is counted.
#pragma once

#include "cloth/free_body.h"
#include "solver/scheme.h"

namespace curtain {

/// Not thread-safe. Allocates nothing after construction.
class LastResort final : public Scheme {
 public:
  /// pattern must outlive this.
  explicit LastResort(const ClothPattern& pattern);

  SubstepStart start(const SubstepPlan& plan, double step, double kick, const NodeForces& forces,
                     const NodeInertia& inertia, const ClothState& state, SubstepOutcome& outcome) noexcept override;

  /// Cuts the velocities [m/s] of a substep of h [s] that starts at `position` [m]; those of nodes with inverse 0 stay.
  /// Returns the momentum taken [N s].
  double cut(const Field3& position, const Field& inverse, double h, double reach, Field3& velocity) noexcept;

  /// After cut(): moves `end` back along the path from where it follows its pins, to where every link with an end that
  /// can move is no longer (a rod no shorter) than by `allowed`, relative, or than the worst of them where the path
  /// begins; where that is far beyond it, any end will do that is not much worse. Returns the share of
  /// the path that is left, and mass times path of what is not, sum over nodes [kg m].
  struct Bound {
    double share = 1.0;
    double moment = 0.0;
  };
  Bound bound(const Field& inverse, double allowed, Field3& end) noexcept;

  /// After cut(): some pin moves, and the path begins where nodes follow it.
  bool pinsMove() const noexcept { return pins_move_; }
  /// Where the path begins, after cut(): nodes follow their pins [m].
  const Field3& follows() const noexcept { return follows_; }

 private:
  bool rigidMotionOfPins(const Field3& position, const Field& inverse, const Field3& velocity,
                         RigidMotion& motion) const noexcept;
  struct Misfit {
    double worst = 0.0, squares = 0.0;
  };
  Misfit misfitOf(const Field3& position, const Field& inverse) const noexcept;
  double shareOf(std::size_t a, std::size_t b, double rest, bool rod, double allowed, double most,
                 const Field3& end) const noexcept;

  const ClothPattern& pattern_;
  bool pins_move_ = false;
  ClothState base_;  // where nodes are, and their cut velocities with all that forces do
  Field3 no_force_;
  Field shortest_;  // link at each node [m]
  Field3 follows_;  // where the pins' rigid motion leads; where nodes are if there are none [m]
};

}  // namespace curtain
