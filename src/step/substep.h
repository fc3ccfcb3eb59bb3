// SPDX-License-Identifier: BSD-3-Clause
//
// Input and output of a substep, and the interface of contact finders.
#pragma once

#include <limits>

#include "cloth/cloth.h"
#include "cloth/stage_clock.h"
#include "step/contacts.h"

namespace curtain {

enum class SchemeKind {
  kLeapfrog,
  kImplicit,
  kLastResort  ///< the smallest step, bounded so that its links hold (schemes/last_resort.h)
};

/// A substep to be made.
struct SubstepPlan {
  SchemeKind scheme = SchemeKind::kLeapfrog;
  double h = 0.0;                                          ///< [s], != 0; negative only for leapfrog
  double reach = std::numeric_limits<double>::infinity();  ///< last resort: trust radius of a node, in links
  bool tells_turning = true;                               ///< compute SubstepOutcome::turning
  bool precise = false;                                    ///< solve rods to rounding
  bool may_be_shorter = false;                             ///< reject it if what it touches asks for that
  double max_phase = 0.0;  ///< mass scaling: nodes with a larger h * omega get the inertia that makes it this; 0:
                           ///< none. The effect vanishes with the step.

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

/// Velocity update v' = keep * v + gain * w * impulse of a node with damping coefficient c and inverse mass w over dt.
/// The exact factors are e^-z and (1 - e^-z) / z with z = c w dt; these rational ones agree to second order, are
/// positive for every z and keep the exact terminal velocity F / c:
///   keep = 1 / (1 + z + z^2/2),  gain = (1 + z/2) / (1 + z + z^2/2).
struct DampedStep {
  double keep;
  double gain;
};

inline DampedStep dampedStep(double coefficient, double inverse_mass, double dt) {
  const double z = coefficient * inverse_mass * dt;
  const double denominator = 1.0 + z + 0.5 * z * z;
  return {1.0 / denominator, (1.0 + 0.5 * z) / denominator};
}

/// The same with damping at the end of the step, v' = v + dt w (F - c v'), as backward Euler needs for its order;
/// also positive and with the exact terminal velocity.
inline DampedStep implicitlyDampedStep(double coefficient, double inverse_mass, double dt) {
  const double share = 1.0 / (1.0 + coefficient * inverse_mass * dt);
  return {share, share};
}

/// The coming substep, for a force that depends on the velocities it leads to.
struct SubstepAhead {
  double kick = 0.0;             ///< time that forces act for [s]
  bool backward = false;         ///< they are wanted at its end; else in its middle
  const Field3* pull = nullptr;  ///< acceleration by what the links pull with [m/s^2]; null: nothing
};

/// Finds contacts, and verifies the result of a substep.
class ContactFinder {
 public:
  virtual ~ContactFinder() = default;

  /// Where the normals are those of the contacts' forces.
  enum class ForcesAct { kAtStart, kAtEnd };
  /// Contacts expected between start and predicted, over a substep of h [s], with their multipliers of the last
  /// substep. Incomplete: verify() decides. Allocates nothing.
  virtual Contacts& begin(const Field3& start, const Field3& predicted, double h, ForcesAct act) noexcept = 0;
  /// Sets the planes of contacts that are curved to those of where their points are now.
  virtual void relinearise(const Field3& position, Contacts& contacts) noexcept = 0;

  enum class Verdict {
    kClear,   ///< nothing has crossed anything
    kMore,    ///< something would: contacts were added, solve again
    kCrossed  ///< something would, and solving again has not helped
  };
  /// Checks the path from start to end. settled: at its end every link is within the tolerance.
  virtual Verdict verify(const Field3& start, const Field3& end, bool settled) noexcept = 0;

  /// Last resort: changes `end` so that nothing crosses anything, whatever that does to the links.
  virtual void hold(const Field3& start, Field3& end) noexcept = 0;
};

/// How a substep went.
struct SubstepOutcome {
  bool accepted = false;  ///< false: nothing was changed, try again with a smaller step
  bool settled = false;   ///< every link is within the tolerance
  bool late = false;      ///< out of computing time before it had settled
  bool touches = false;   ///< a contact pushes
  int sweeps = 0;
  double scale = 0.0;                                             ///< h * kick [s^2]
  double kick = 0.0;                                              ///< time that the forces acted for [s]
  double share = 1.0;                                             ///< of the path that the last resort leaves, [0..1]
  double momentum_cut = 0.0;                                      ///< by the last resort [N s]
  double dissipated = 0.0;                                        ///< by friction within elastic parts [J]
  bool pins_wait = false;                                         ///< moved pins stayed where they were
  double longest_step = std::numeric_limits<double>::infinity();  ///< limit for the next step from moving contacts [s]
  double turning = 0.0;        ///< Step::turning() [1/s]; 0 with pulling strings or contacts: jumps are no turns
  double omega_squared = 0.0;  ///< bound of the highest frequency squared, from the links' tensions [1/s^2]
};

}  // namespace curtain
