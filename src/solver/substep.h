// SPDX-License-Identifier: BSD-3-Clause
//
// What a scheme is given for one substep, what it gives back, and what else may constrain the nodes meanwhile.
#pragma once

#include <limits>

#include "cloth/cloth.h"
#include "solver/contacts.h"
#include "solver/stage_clock.h"

namespace curtain {

enum class SchemeKind {
  kLeapfrog,
  kBdf2,
  kImplicit,
  kLastResort  ///< the smallest step: taken as far as its links hold (schemes/last_resort.h)
};

/// A substep to be made.
struct SubstepPlan {
  SchemeKind scheme = SchemeKind::kLeapfrog;
  double h = 0.0;  ///< [s], != 0; negative only for leapfrog
  double reach =
      std::numeric_limits<double>::infinity();  ///< last resort: most that a node may be predicted to move, in links
  bool tells_turning = true;                    ///< SubstepOutcome::turning is read
  bool precise = false;                         ///< rods are solved to rounding
  double most_phase = 0.0;  ///< nodes whose tensions ask for a larger h * omega answer forces as if they were heavier,
                            ///< so that theirs is this; 0: none does. Vanishes with the step.

  bool isLastResort() const noexcept { return scheme == SchemeKind::kLastResort; }
};

/// Forces at the start of a substep.
struct NodeForces {
  const Field3* force = nullptr;  ///< [N], all but damping
  bool weight_only = true;        ///< force is mass times gravity
  Vec3 gravity = Vec3::Zero();    ///< [m/s^2]
  Field damping;                  ///< force = -damping * velocity [kg/s]; only read when has_damping
  bool has_damping = false;
};

/// Who finds what may touch, and judges what a substep has come to.
class ContactFinder {
 public:
  virtual ~ContactFinder() = default;

  /// What may touch on the way from start to predicted, over a substep of length h [s], with the multipliers of the
  /// last substep. None: a hint, no more; what the cloth does is for verify(). Allocates nothing.
  virtual Contacts& begin(const Field3& start, const Field3& predicted, double h) noexcept = 0;

  enum class Verdict {
    kClear,   ///< nothing has gone through anything
    kMore,    ///< something would: contacts were added, solve again
    kCrossed  ///< something would, and solving again has not helped
  };
  /// Looks at the way from start to end, which is to be taken. settled: at its end every link is within the tolerance.
  virtual Verdict verify(const Field3& start, const Field3& end, bool settled) noexcept = 0;

  /// The last resort: changes `end` so that nothing goes through anything, whatever it does to the links.
  virtual void hold(const Field3& start, Field3& end) noexcept = 0;
};

/// How a substep went.
struct SubstepOutcome {
  bool accepted = false;   ///< false: nothing was changed, try again with a smaller step
  bool settled = false;    ///< every link is within the tolerance
  bool disturbed = false;  ///< columns that are held would move: wake them and make the substep again
  bool late = false;       ///< its time was over before it had settled
  bool touches = false;    ///< something presses
  int sweeps = 0;
  double scale = 0.0;                                             ///< h times the time the forces acted for [s^2]
  double kick = 0.0;                                              ///< the time the forces acted for [s]
  double share = 1.0;                                             ///< of the path that the last resort leaves, [0..1]
  double momentum_cut = 0.0;                                      ///< by the last resort [N s]
  bool pins_wait = false;                                         ///< moved pins stayed where they were, too
  double longest_step = std::numeric_limits<double>::infinity();  ///< in which what pushes goes a share of a link [s]
  double turning =
      0.0;  ///< ExactSolver::turning() [1/s]; 0 where a string pulls or a contact pushes: jumps are no turns
  double omega_squared = 0.0;  ///< bound of the square of the highest frequency, from the links' tensions [1/s^2]
};

}  // namespace curtain
