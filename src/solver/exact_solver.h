// SPDX-License-Identifier: BSD-3-Clause
//
// The exact schemes: one substep of point masses, two-sided warp rods and one-sided weft links, whose constraint
// forces are solved for (not approached by relaxation): per column one tridiagonal system for the rod tensions, per row
// one for the weft, the two (and contact) alternated until every link is within tolerance. On unsheared cloth warp and
// weft forces are orthogonal and one sweep does; shear makes it a few.
//
//   leapfrog  forces act along the links' directions at the start of the step, velocities live half a step behind
//             (SHAKE: Ryckaert, Ciccotti, Berendsen 1977): order 2, symplectic, needs dt * omega_max < 2
//   implicit  along the directions at the end of the step: order 1, damps, stable at any step
#pragma once

#include "solver/substep.h"
#include "solver/warp_solver.h"
#include "solver/weft_solver.h"

namespace curtain {

enum class Scheme { kLeapfrog, kImplicit };

class ExactSolver {
 public:
  /// stretch_tolerance  relative overlength allowed to a link
  /// max_sweeps         bound of the warp/weft/contact sweeps in a substep
  ExactSolver(const ClothPattern& pattern, double stretch_tolerance, int max_sweeps);

  /// Forgets the tensions of the last substep.
  void reset() noexcept;

  /// One substep of length h > 0 [s]. constraints may be null. With must_accept the step is taken even when links
  /// are left above the tolerance, unless the result is not finite. Allocates nothing.
  SubstepOutcome substep(Scheme scheme, const NodeForces& forces, double h, bool must_accept,
                         PositionConstraints* constraints, ClothState& state, StageClock& clock) noexcept;

  /// How nodes answered impulses in the last substep [1/kg].
  const Field& inverseInertia() const noexcept { return inertia_ != nullptr ? *inertia_ : pattern_.inverse_mass; }

  /// Velocities at the time of the positions (leapfrog keeps them half a substep behind): advanced by the forces and
  /// made to agree with the links that pull.
  void currentVelocities(const ClothState& state, const NodeForces& forces, PositionConstraints* constraints,
                         Field3& out) noexcept;

 private:
  struct Progress {
    bool settled = false;    // every link is within the user's tolerance
    bool left_over = false;  // but not within what the step's length asks for
    int sweeps = 0;
  };
  void predict(const NodeForces& forces, double kick, double h, const ClothState& state) noexcept;
  void warmStart(Scheme scheme, double scale, const LineSolve& warp, const LineSolve& weft) noexcept;
  Progress solveConstraints(Scheme scheme, double h, bool must_accept, PositionConstraints* constraints,
                            StageClock& clock) noexcept;
  bool withinTolerance(const LineSolve& warp, const LineSolve& weft, double tolerance) noexcept;
  void projectVelocity(const Field3& position, PositionConstraints* constraints, Field3& out) noexcept;
  struct WarpProgress {
    bool converged = false;
    double first_residual = 0.0;  // before the first iteration
    double last_residual = 0.0;   // before the last one
  };
  bool solveBlock(Scheme scheme, const LineSolve& warp, int block, double stop, WarpProgress& progress) noexcept;
  WarpProgress solveWarp(Scheme scheme, const LineSolve& warp, double tolerance, bool first_sweep) noexcept;
  double omegaSquared(double scale) const noexcept;
  void commit(double h, double velocity_age, ClothState& state) noexcept;

  const ClothPattern& pattern_;
  double tolerance_;          // relative, inside the solver
  double contact_tolerance_;  // [m]
  int max_sweeps_;
  WeftSolver weft_solver_;
  LineScratch scratch_;
  LinkSet warp_, weft_;
  Field last_warp_, last_weft_;  // multipliers of the last accepted substep
  double last_scale_ = 0.0;      // its h * kick [s^2]; 0 = none yet
  Field damped_inertia_;
  const Field* inertia_ = nullptr;
  Field3 next_;
};

}  // namespace curtain
