// SPDX-License-Identifier: BSD-3-Clause
//
// The exact schemes: one substep of point masses, two-sided warp rods and one-sided weft strings, whose constraint
// forces are solved for. What the schemes share is here: a substep is predicted, solved and verified, judged, and
// taken. Equations are those of docs/method.md, "A substep".
//
//   step.cpp          a substep
//   step_between.cpp  velocities, pulls and works between two substeps
#pragma once

#include <limits>

#include "step/constraints.h"
#include "step/energy_account.h"
#include "step/schemes/implicit.h"
#include "step/schemes/last_resort.h"
#include "step/schemes/leapfrog.h"
#include "step/sweeps.h"

namespace curtain {

class Step {
 public:
  /// parts              must outlive this
  /// stretch_tolerance  relative overlength allowed to a link
  /// max_sweeps         bound of the sweeps in a substep
  Step(const ClothPattern& pattern, const SolverParts& parts, double stretch_tolerance, int max_sweeps,
       const Workers& workers);

  /// Reserves room for so many contacts; more make a substep allocate.
  void expectContacts(std::size_t count) { constraints_.expectContacts(count); }

  /// Sets the relative overlength allowed to a link, between substeps.
  void setStretchTolerance(double tolerance) noexcept;

  /// Forgets the tensions of the last substep.
  void reset() noexcept;

  /// Updates what depends on the pattern's pins. Allocates nothing.
  void pinsChanged() noexcept;
  /// After it, when the pins have changed: what the last substep left is that of other pins.
  void afterPinsChanged() noexcept;

  /// One substep. finder may be null: nothing to touch. Allocates nothing.
  SubstepOutcome substep(const SubstepPlan& plan, const NodeForces& forces, ContactFinder* finder, ClothState& state,
                         StageClock& clock) noexcept;

  /// Pull of the links at a node in the last substep: sum of multiplier times direction [kg m]; divided by the
  /// substep's scale it is a force.
  Vec3 pullAt(int row, int column) const noexcept { return constraints_.pullAt(row, column); }

  /// Tensions of the rod above a node and of the link to its left in the last substep [N].
  Constraints::LinkTensions tensionsAt(int row, int column) const noexcept {
    return constraints_.tensionsAt(row, column, inertia_.tensions().scale);
  }

  /// Tension of a distance that a part bounds, in the last substep [N].
  double tensionOf(const DistanceRow& row) const noexcept {
    const double scale = inertia_.tensions().scale;
    return scale != 0.0 ? row.last * row.length / scale : 0.0;
  }

  /// Forces of the last substep with elastic ones [N]; null: limp cloth.
  const Field3* forcesWithElastic() const noexcept { return elastic_ != nullptr ? &elastic_->sum() : nullptr; }
  /// Elastic energy after a substep with these forces, as leapfrog keeps it with that of motion [J].
  double elasticEnergy(const Field3& outer, const Field3& position) const noexcept {
    return distances().energy(position) + (elastic_ != nullptr ? elastic_->energyAfter(outer, position) : 0.0);
  }
  /// From here on elastic parts are as stiff as the last substep bears, by what a snapshot holds.
  void beginElastic() noexcept;
  /// Elastic force at these positions [N], and its energy [J], as a substep like the last one sees them;
  /// null and 0: limp cloth.
  const Field3* elasticAt(const Field3& position, double& energy) noexcept;

  /// Velocities at the time of the positions (leapfrog keeps them half a substep behind): advanced by the forces and
  /// projected on the constraints. contacts: of the last substep, or null.
  void currentVelocities(const ClothState& state, const NodeForces& forces, const Contacts* contacts,
                         Field3& out) noexcept;

  /// Time that the forces of a planned substep act for [s], and whether they are wanted at its end.
  double kickOf(const SubstepPlan& plan, const ClothState& state) noexcept {
    return state.velocity_age + (1.0 - schemeOf(plan.scheme).rules().age) * plan.h;
  }
  bool isBackward(const SubstepPlan& plan) noexcept { return schemeOf(plan.scheme).rules().backward; }
  /// Acceleration by what links and contacts (or null) pulled with in the last substep, along their present directions
  /// [m/s^2]. Between substeps only.
  void copyPulls(const ClothState& state, const Contacts* contacts, Field3& out) noexcept;

  /// Books the work of all but contacts in an accepted substep, before which the account was opened.
  void book(const ClothState& state, const NodeForces& forces, const SubstepOutcome& outcome) noexcept;
  EnergyAccount& account() noexcept { return account_; }
  const EnergyAccount& account() const noexcept { return account_; }

  /// The last substep's tensions and inertia.
  const NodeInertia& inertia() const noexcept { return inertia_; }

  /// The part of nodes that do not move freely; null: none.
  const GuidePart* guide() const noexcept { return constraints_.guide(); }

  /// What parts bound.
  const DistanceRows& distances() const noexcept { return constraints_.distances(); }

  /// A string, or a distance, pulled in the last substep.
  bool stringsPull() const noexcept { return constraints_.stringsPull(); }

  /// What a substep leaves to the next; restored when substeps are repeated.
  struct Memory {
    Constraints::Memory constraints;
    NodeInertia::Tensions tensions;
    double held = 0.0;  // EnergyAccount::held()
    bool left_off = false;
    std::vector<double> guide, elastic;

    void serialize(Archive& archive);
  };
  void save(Memory& memory) const;
  void restore(const Memory& memory);

  void serialize(Archive& archive);
  /// After serialize() has loaded: restores what is not serialized.
  void resume(const ClothState& state) noexcept;

 private:
  // A substep being made.
  struct Attempt {
    const SubstepPlan& plan;
    const NodeForces& forces;
    ContactFinder* finder;
    ClothState& state;
    StageClock& clock;
    Scheme& scheme;
    double kick;   // [s]
    double ratio;  // multipliers now over those of the last substep
    SubstepStart start;

    double scale() const noexcept { return plan.h * kick; }
  };
  // Result of the solves of a substep.
  struct Progress {
    SweepEnd end = SweepEnd::kStalled;
    bool settled = false;              // every link is within the user's tolerance
    bool crossed = false;              // verification found a crossing
    bool late = false;                 // out of computing time before convergence
    double predicted_violation = 0.0;  // of SweepOutcome
    EnergyAccount::Entry energy;
    int sweeps = 0;
  };
  Scheme& schemeOf(SchemeKind kind) noexcept;
  Attempt predict(const SubstepPlan& plan, const NodeForces& forces, ContactFinder* finder, ClothState& state,
                  StageClock& clock, SubstepOutcome& outcome) noexcept;
  Progress solveAndVerify(const Attempt& attempt) noexcept;
  void judge(const Attempt& attempt, Progress& progress, SubstepOutcome& outcome) noexcept;
  void boundPath(const Attempt& attempt, const Progress& progress, SubstepOutcome& outcome) noexcept;
  void accept(const Attempt& attempt, const Progress& progress, SubstepOutcome& outcome) noexcept;
  double meanSquare(const Field3& velocity) const noexcept;
  bool needsEnergyCheck(const Attempt& attempt, const Progress& progress) const noexcept;
  void keepMomentum(const SubstepStart& start) noexcept;
  void projectVelocity(const Field3& position, double share, Field3& out) noexcept;
  double turning(double kick) const noexcept;
  const Contacts& contacts() const noexcept { return constraints_.contacts().all(); }

  const ClothPattern& pattern_;
  bool free_;                 // no node is pinned
  bool left_off_ = false;     // the last substep has not brought links and contacts to where they are to be
  double stretch_tolerance_;  // the user's, relative
  double smallest_rest_;      // of a link [m]
  NodeInertia inertia_;
  ElasticPart* elastic_;  // null: limp cloth
  Constraints constraints_;
  Sweeps sweeps_;
  EnergyAccount account_;
  Leapfrog leapfrog_;
  Implicit implicit_;
  LastResort last_resort_;
};

}  // namespace curtain
