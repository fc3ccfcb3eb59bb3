// SPDX-License-Identifier: BSD-3-Clause
//
// The cloth in motion: state, parts, obstacles, the solvers that make a substep, and statistics.
#pragma once

#include "contact/cloth_contact.h"
#include "curtain_sim/statistics.h"
#include "methods/paper/paper_solver.h"
#include "simulator/composition.h"
#include "simulator/force_field.h"
#include "simulator/obstacle_lag.h"
#include "step/step.h"

namespace curtain {

/// Not thread-safe. Allocates only in the constructor.
struct Motion {
  /// Start of a trial run or of a substep of stages. Of the statistics only the work is restored.
  struct Checkpoint {
    ClothState state;
    Step::Memory memory;
    Work work;
  };

  /// scene, pattern and times must outlive this. Throws std::invalid_argument for a mesh that can't be used.
  Motion(const Scene& scene, const ClothPattern& pattern, const FrameTimes& times, const ShapeMaker& make_shape);
  void reset();

  /// One attempt at a substep from `done` seconds into the frame.
  SubstepOutcome attempt(const SubstepPlan& plan, double done);
  void save(Checkpoint& checkpoint) const;
  void restore(const Checkpoint& checkpoint);

  /// Something but links, gravity and obstacles may put energy in.
  bool driven() const;

  /// A substep of h [s] that was planned, was accepted.
  void substepAccepted(double h, const SubstepOutcome& outcome) noexcept;
  /// Updates what depends on the pattern's pins. Allocates nothing but for Method::kPaper.
  void pinsChanged();
  /// After it: what the last substep left is that of other pins.
  void afterPinsChanged() noexcept;

  /// Contacts that pushed in the last accepted substep; null: none.
  const Contacts* pushing() const noexcept { return contact.pushing().empty() ? nullptr : &contact.pushing(); }
  /// Velocities at the time of the positions; cached until forgetVelocities().
  const Field3& velocities();
  void forgetVelocities() noexcept { velocities_fresh_ = false; }
  /// Brings the velocities to the time of the positions, before the length of the steps changes: they lag by half a
  /// step of the old length.
  void synchronise();
  Energy energy();

  /// Writes what the parts say and the links' present stretch to the statistics; measure(): and the rest, after a
  /// frame.
  void measureState() noexcept;
  void measure() noexcept;

  void serializeVelocities(Archive& archive);

  const Scene& scene;
  const ClothPattern& pattern;
  const FrameTimes& times;
  ClothState initial;
  ClothState state;
  ObstacleSet obstacles;
  Workers workers;
  Composition parts;
  ForceField forces;
  ClothContact contact;
  ObstacleLag lag;
  Step step;
  PaperSolver paper;
  bool counts_work = false;
  Statistics statistics;
  StageClock clock;

 private:
  void measureParts() noexcept;
  void book(const NodeForces& acting, double h, const SubstepOutcome& outcome) noexcept;
  void computeVelocities() noexcept;

  Field3 velocities_;
  Field3 pulls_;  // scratch of attempt()
  bool velocities_fresh_ = false;
};

}  // namespace curtain
