// SPDX-License-Identifier: BSD-3-Clause
//
// What distinguishes the exact schemes: where a substep starts, how long forces act in it, and along which directions
// links pull. The solve is the same for all. One file a scheme in schemes/.
//
// Elastic forces act at the positions that a substep starts from, or, where the links follow, at those it would lead to
// without links and them.
#pragma once

#include "step/elastic_part.h"
#include "step/node_inertia.h"
#include "step/substep.h"
#include "step/warp_solver.h"

namespace curtain {

class Scheme {
 public:
  struct Rules {
    bool follows;   ///< links pull along their directions at the end of the step, not at its start
    bool backward;  ///< damping acts on the velocities at the end
    double age;     ///< velocities lag behind the positions by this share of a step
  };

  explicit Scheme(const Rules& rules) noexcept : rules_(rules) {}
  virtual ~Scheme() = default;

  const Rules& rules() const noexcept { return rules_; }

  /// A substep about to be made.
  struct Task {
    const SubstepPlan& plan;
    double kick;  ///< [s]
    const NodeForces& forces;
    const NodeInertia& inertia;  ///< set for it
    ElasticPart* elastic;        ///< begun for it; null: limp cloth
  };
  /// Start of the substep. Momentum that is not taken along is added to the outcome.
  virtual SubstepStart start(const Task& task, const ClothState& state, SubstepOutcome& outcome) noexcept {
    (void)outcome;
    return startFrom(state, task);
  }

 protected:
  SubstepStart startFrom(const ClothState& base, const Task& task) const noexcept {
    const bool falls = task.forces.weight_only && task.inertia.massesAlone() && task.elastic == nullptr;
    return {base,       forceFrom(base, task), falls ? &task.forces.gravity : nullptr, task.inertia.keep(), task.kick,
            task.plan.h};
  }

  /// All forces but those of links and damping, of a substep from here.
  const Field3& forceFrom(const ClothState& base, const Task& task) const noexcept {
    const Field3& outer = *task.forces.force;
    if (task.elastic == nullptr) return outer;
    if (!rules_.follows) return task.elastic->addTo(outer, base.position);
    return task.elastic->addAhead({base, outer, nullptr, task.inertia.keep(), task.kick, task.plan.h},
                                  task.inertia.inverse());
  }

 private:
  const Rules rules_;
};

}  // namespace curtain
