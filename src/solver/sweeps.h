// SPDX-License-Identifier: BSD-3-Clause
//
// The sweeps of a solve: rods, then all taut strings and contacts at once, until links and contacts are within what is
// aimed at. Cloth without a taut string that touches nothing never leaves the first half of the first sweep.
//
// Directions of the substep's start do for a leapfrog step as long as they have a solution. What its first sweep leaves
// is corrected along the present directions, all of it: forces along the directions at the start may have no solution
// at all where a flat net shears, and a correction along one set of directions taken back along another is a force that
// does work. In contact they are kept: what is dropped on a box gains energy else (test/stress).
#pragma once

#include <limits>

#include "solver/constants.h"
#include "solver/constraints.h"
#include "solver/scheme.h"

namespace curtain {

/// How a solve has ended.
enum class SweepEnd {
  kConverged,  ///< links and contacts are as near as was aimed at
  kStalled,    ///< more sweeps bring them no nearer, or there were as many as there may be
  kOutOfTime,  ///< its time is over
  kDiverged    ///< rods turned over, or a number is not finite
};

struct SweepOutcome {
  SweepEnd end = SweepEnd::kStalled;
  bool within = false;  ///< links and contacts are within the user's tolerance
  int sweeps = 0;
  double surprise = 0.0;  ///< most that a rod lacked where it began, relative
};

/// What is to be solved.
struct SweepTask {
  const Field3& start;  ///< where directions at the substep's start are taken [m]
  bool follows;         ///< links pull along their directions at its end
  bool last_resort;     ///< monotone: a sweep that makes the sum of squares no smaller is undone
  bool precise;         ///< rods are solved to rounding
  double weight_path;   ///< that weight moves a node by in the substep [m]
  double path;  ///< that nodes go in it at the speed they have, RMS past their mean [m]; read where something touches
};

/// How much a sweep's solve of strings and contacts is damped: the more the more sweeps went wrong.
class SweepDamping {
 public:
  /// largest: Levenberg-Marquardt term over the diagonal.
  explicit SweepDamping(double largest) noexcept : largest_(largest) {}
  void better() noexcept { factor_ = std::max(1.0, factor_ / kLessCaution); }
  void worse() noexcept { factor_ *= kMoreCaution; }
  /// The term at this residual.
  double at(double residual) const noexcept { return std::min(largest_, wanted(residual)); }
  /// Nothing is left to gain by more of it.
  bool exhausted(double residual) const noexcept { return wanted(residual) > largest_; }

 private:
  double wanted(double residual) const noexcept { return factor_ * kDampingPerResidual * residual; }

  const double largest_;
  double factor_ = 1.0;
};

/// Sweeps must bring some improvement over a window of them, or the solve has stalled.
class StallWatch {
 public:
  bool stalls(int sweeps, double residual) noexcept;

 private:
  double before_ = std::numeric_limits<double>::infinity();
};

/// Not thread-safe. Allocates nothing.
class Sweeps {
 public:
  /// tolerance  relative, of links; contact_tolerance  [m]; both as the user has them. constraints and inertia must
  /// outlive this.
  Sweeps(Constraints& constraints, const NodeInertia& inertia, double tolerance, double contact_tolerance,
         int most_sweeps);

  /// Moves constraints.next to where links and contacts are satisfied; contacts: null where nothing can touch.
  SweepOutcome run(const SweepTask& task, Contacts* contacts, StageClock& clock) noexcept;

 private:
  // What one sweep is to reach, and what it leaves alone.
  struct Aim {
    double links, contact;  // relative, [m]
    double share;           // of it within which a solve ends
    double alone;           // of it within which strings and contacts are not touched
  };
  struct Residual {
    Constraints::RodsProgress rods;
    double strings = 0.0, touch = 0.0;  // relative, [m]
  };
  Aim aimOf(const SweepTask& task, bool first, bool touches, int sweeps) const noexcept;
  Residual look(Contacts* contacts, const Constraints::RodsProgress& rods, bool first, int sweeps,
                StageClock& clock) noexcept;
  bool reached(const Aim& aim, const Residual& residual) noexcept;
  struct Best {
    double merit = std::numeric_limits<double>::infinity(), residual = 0.0;
  };
  bool keepOrUndo(double& residual, const Residual& now, Contacts* contacts, SweepDamping& damping) noexcept;
  SweepOutcome conclude(SweepOutcome outcome, double touch, Contacts* contacts) noexcept;
  bool isWithin(double touch) noexcept;

  Constraints& constraints_;
  const NodeInertia& inertia_;
  const double tolerance_;          // inside the solver
  const double contact_tolerance_;  // [m]
  const int most_sweeps_;
  Best best_;                // of a monotone solve
  double most_touch_ = 0.0;  // that contacts may lack in the end [m]
};

}  // namespace curtain
