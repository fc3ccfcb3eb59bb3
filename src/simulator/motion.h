// SPDX-License-Identifier: BSD-3-Clause
//
// The cloth in motion: its state, what acts on it, the solvers that make a substep of it, and what is counted
// meanwhile.
#pragma once

#include "contact/cloth_contact.h"
#include "curtain_sim/statistics.h"
#include "simulator/energy_ledger.h"
#include "simulator/force_field.h"
#include "simulator/obstacle_lag.h"
#include "solver/exact_solver.h"
#include "solver/schemes/paper_solver.h"

namespace curtain {

/// Not thread-safe. Allocates nothing after construction.
struct Motion {
  /// What a motion made in trial goes back to; what has been counted is not in it but for the work.
  struct Checkpoint {
    ClothState state;
    ExactSolver::Memory memory;
    Work work;
  };

  /// scene, pattern and times must outlive this. Throws std::invalid_argument for a mesh that can't be used.
  Motion(const Scene& scene, const ClothPattern& pattern, const FrameTimes& times, const MeshResolver& resolve);
  void reset();

  /// One attempt at a substep from `done` seconds into the frame.
  SubstepOutcome attempt(const SubstepPlan& plan, double done);
  void save(Checkpoint& checkpoint) const;
  void restore(const Checkpoint& checkpoint);

  /// That pushed in the last accepted substep; null: none did.
  const Contacts* pushing() const noexcept { return contact.pushing().empty() ? nullptr : &contact.pushing(); }
  /// At the time of the positions; kept until forgetVelocities().
  const Field3& velocities();
  void forgetVelocities() noexcept { velocities_fresh_ = false; }
  /// Takes the velocities to the time of the positions. A step of another length than the last one's would else start
  /// from a velocity half the difference off.
  void synchronise();
  Energy energy();

  /// Takes the links' stretches of now into the statistics, and after a frame the rest of what is measured then.
  void measureStretch() noexcept;
  void measure() noexcept;

  void carryVelocities(Archive& archive);

  const Scene& scene;
  const ClothPattern& pattern;
  const FrameTimes& times;
  const ClothState initial;
  ClothState state;
  ForceField forces;
  ObstacleSet obstacles;
  Workers workers;
  ClothContact contact;
  ObstacleLag lag;
  ExactSolver exact;
  PaperSolver paper;
  EnergyLedger ledger;
  bool counts_work = false;
  Statistics statistics;
  StageClock clock;

 private:
  void computeVelocities() noexcept;

  Field3 velocities_;
  bool velocities_fresh_ = false;
};

}  // namespace curtain
