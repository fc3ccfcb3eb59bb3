// SPDX-License-Identifier: BSD-3-Clause
//
// What a simulator is made of. simulator.cpp: what users call; frame.cpp: frames and their substeps; sleep.cpp: those in
// which not all of it moves; companion.cpp: the position tolerance; snapshot.cpp: what is kept of it and comes back.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "contact/cloth_contact.h"
#include "curtain_sim/plan.h"
#include "curtain_sim/simulator.h"
#include "simulator/budget.h"
#include "simulator/energy_ledger.h"
#include "simulator/error_estimate.h"
#include "simulator/fine_surface.h"
#include "simulator/force_field.h"
#include "simulator/rest.h"
#include "solver/exact_solver.h"
#include "solver/paper_solver.h"
#include "solver/step_control.h"

namespace curtain {

struct Simulator::Impl {
  Impl(const Scene& given, const MeshResolver& resolve);

  double frameLength() const { return 1.0 / scene.solver.frame_rate; }  // [s]
  // When this frame begins, or did [s]: whole frames from where they last changed their length, so that nothing adds up.
  double timeOf(std::int64_t of_frame) const {
    return same_since.time + static_cast<double>(of_frame - same_since.frame) * frameLength();
  }

  void reset();
  void step();
  void startPins();
  void stopPins(bool whole);
  double makeFrame();
  void estimateError();
  bool makeEvenSubstep(const SubstepPlan& plan, double done, int divisions);
  bool makeEvenFrame(int substeps);
  int stableSubsteps() const noexcept;
  void rehearse();
  void moveCompanion();
  void synchronise();
  double makeSubstep(double done);
  void setObstacles(const SubstepPlan& plan, double done) noexcept;
  void countStops(bool last_resort, const SubstepOutcome& outcome, double h) noexcept;
  bool makeComposed(const SubstepPlan& plan, double done);
  SubstepPlan planSubstep(StepControl& steps, double remaining);
  SubstepOutcome attempt(const SubstepPlan& plan, double done);
  SubstepOutcome attemptInTime(const SubstepPlan& plan, double done);
  void measure();
  void wakeForFrame();
  void sleepThrough();
  void fallAsleep();
  void takeOverSleepers();
  void wakeAll();
  void setRestLimits();
  void planForces(Plan& plan) const;
  void planSolver(Plan& plan) const;
  void planContact(Plan& plan) const;
  void countTime(Budget::Clock::time_point begin);
  void prepareFrame(Budget::Clock::time_point begin);
  void finishFrame(double share);
  const Field3& currentVelocities();
  Energy energy();
  double energyWithoutLinks() const noexcept;
  bool isClosed() const noexcept;
  void keepEnergy();
  void carry(Archive& archive);
  void resume() noexcept;
  std::uint32_t layout();

  Scene scene;  // gravity and air may change
  const ClothPattern pattern;
  const ClothState initial;
  ClothState state;
  ForceField forces;
  ObstacleSet obstacles;
  ClothContact contact;
  Workers workers;
  ExactSolver exact;
  PaperSolver paper;
  StepControl control;
  int plain_frames = 0;       // to go before leapfrog4 composes again
  StepControl plain_control;  // for leapfrog4, where its stages can't be made
  FineSurface surface;
  Rest rest;
  ColumnSet kept_awake;  // scratch
  EnergyLedger ledger;
  bool counts_work = false;
  Budget budget;
  // What a substep of several stages goes back to.
  struct {
    ClothState state;
    ExactSolver::Memory memory;
    Work work;
  } before;
  // With a position tolerance: the estimate, the motion's companion, and what to go back to.
  struct Held {
    ClothState state;
    ExactSolver::Memory memory;
    int substeps = 0;   // a frame
    int steps = 0;      // leapfrog steps in the last frame
    bool of_stages = true;
    bool lost = false;  // a substep failed
    bool in_finer_steps = false;

    void carry(Archive& archive);
  };
  std::unique_ptr<ErrorEstimate> estimate;
  Held companion, rehearsal;
  int steps_made = 0;      // leapfrog steps of the present frame, for the estimate
  bool pins_wait = false;      // they have not got where they are told to in this frame
  double obstacle_share = 1.0;  // of the substep's motion that obstacles make
  double obstacle_lag = 0.0;  // that obstacles have waited in this frame for cloth that could not give way [s]
  bool of_stages = true;   // all of them were stages of whole substeps
  struct PinMove {
    std::size_t node;
    Vec3 target;
    bool behind;  // it did not get there in the last frame

    void carry(Archive& archive, const ClothPattern& of);
  };
  std::vector<PinMove> pin_moves;  // of the coming frame
  Statistics statistics;
  StageClock clock;
  std::int64_t frame = 0;
  // Since when frames have been as long as they are.
  struct {
    std::int64_t frame = 0;
    double time = 0.0;  // [s]
  } same_since;
  const bool has_pins;
  const double total_mass;  // [kg]
  const double shortest_link;  // [m]
  std::optional<double> most_energy;  // while nothing puts any in [J]
  double made_time = 0.0;      // of motion; less than the frames' where these ended early [s]
  std::uint64_t revision = 0;  // of the cloth's and the obstacles' places
  Field3 velocities;           // at the time of the positions
  bool velocities_fresh = false;
  Field3 total_force;          // room for what copyForces() adds up
};

}  // namespace curtain
