// SPDX-License-Identifier: BSD-3-Clause
//
// The sweeps of a solve: rods, then all taut strings and contacts at once, until links and contacts are within the aim.
// Cloth without a taut string and without contact ends after the rods of the first sweep.
//
// Leapfrog's first sweep pulls along the directions at the start of the step. If it does not converge, the whole
// correction follows the present directions: along the old ones a sheared flat net may have no solution, and a
// correction along one set of directions that is undone along another does work. In contact directions are kept, since
// otherwise what is dropped on a box gains energy (test/stress).
#pragma once

#include <limits>

#include "step/constants.h"
#include "step/constraints.h"
#include "step/scheme.h"

namespace curtain {

/// How a solve has ended.
enum class SweepEnd {
  kConverged,  ///< links and contacts are within the aim
  kStalled,    ///< more sweeps do not help, or there were max_sweeps
  kOutOfTime,  ///< the deadline has passed
  kDiverged    ///< rods turned over, or a number is not finite
};

struct SweepOutcome {
  SweepEnd end = SweepEnd::kStalled;
  bool within = false;  ///< links and contacts are within the user's tolerance
  int sweeps = 0;
  double predicted_violation = 0.0;  ///< largest relative violation of a rod at the start
};

/// A problem for the sweeps.
struct SweepTask {
  const Field3& start;  ///< positions at the start of the substep [m]
  bool follows;         ///< links pull along their directions at its end
  bool last_resort;     ///< monotone: a sweep that does not reduce the sum of squares is undone
  bool precise;         ///< solve rods to rounding
  double weight_path;   ///< displacement by weight in the substep [m]
  double path;          ///< displacement at the present velocities, RMS relative to the mean [m]; read with contacts
};

/// Damping of the solve of strings and contacts: grows while sweeps make things worse.
class SweepDamping {
 public:
  /// largest: Levenberg-Marquardt term over the diagonal.
  explicit SweepDamping(double largest) noexcept : largest_(largest) {}
  void better() noexcept { factor_ = std::max(1.0, factor_ / kDampingShrink); }
  void worse() noexcept { factor_ *= kDampingGrowth; }
  /// The term at this residual.
  double at(double residual) const noexcept { return std::min(largest_, wanted(residual)); }
  /// The damping is at its largest.
  bool exhausted(double residual) const noexcept { return wanted(residual) > largest_; }

 private:
  double wanted(double residual) const noexcept { return factor_ * kDampingPerResidual * residual; }

  const double largest_;
  double factor_ = 1.0;
};

/// Detects that a window of sweeps has brought too little improvement.
class StallWatch {
 public:
  bool stalls(int sweeps, double residual) noexcept;

 private:
  double before_ = std::numeric_limits<double>::infinity();
};

/// Not thread-safe. Allocates nothing.
class Sweeps {
 public:
  /// tolerance: relative, of links; contact_tolerance: [m]; both the user's. constraints and inertia must outlive this.
  Sweeps(Constraints& constraints, const NodeInertia& inertia, double tolerance, double contact_tolerance,
         int max_sweeps);

  void setTolerances(double tolerance, double contact_tolerance) noexcept {
    tolerance_ = kInnerTolerance * tolerance;
    contact_tolerance_ = kInnerTolerance * contact_tolerance;
  }

  /// Moves constraints.next to satisfy links and contacts.
  SweepOutcome run(const SweepTask& task, StageClock& clock) noexcept;
  /// Whether links are within the user's tolerance in constraints.next.
  bool linksHold() noexcept;

 private:
  // What one sweep aims at, and what it does not correct.
  struct Aim {
    double links, contact;  // relative, [m]
    double share;           // of the aim at which the solve ends
    double alone;           // of the aim below which strings and contacts are not corrected
  };
  struct Residual {
    Constraints::RodsProgress rods;
    double strings = 0.0, touch = 0.0;  // relative, [m]
  };
  double touchAim(const SweepTask& task, double least) const noexcept;
  Aim aimOf(const SweepTask& task, bool touches, int sweeps) const noexcept;
  Residual measureResidual(const Constraints::RodsProgress& rods, bool first, bool turns, StageClock& clock) noexcept;
  bool reached(const Aim& aim, const Residual& residual) noexcept;
  struct Best {
    double merit = std::numeric_limits<double>::infinity(), residual = 0.0;
  };
  bool keepOrUndo(double& residual, const Residual& now, SweepDamping& damping) noexcept;
  SweepOutcome conclude(SweepOutcome outcome) noexcept;
  bool isWithin(bool recovers) noexcept;

  Constraints& constraints_;
  const NodeInertia& inertia_;
  double tolerance_;          // inside the solver, relative
  double contact_tolerance_;  // [m]
  const int max_sweeps_;
  Best best_;               // iterate of a monotone solve
  double max_touch_ = 0.0;  // final tolerance of contacts [m]
};

}  // namespace curtain
