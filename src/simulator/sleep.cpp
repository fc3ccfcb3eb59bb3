// SPDX-License-Identifier: BSD-3-Clause
//
// Frames of cloth that sleeps: what wakes it, what falls asleep, and the frame in which nothing moves.
#include "simulator/simulator_impl.h"

namespace curtain {

// Before a frame: wakes the columns that something in it may move.
void Simulator::Impl::wakeForFrame() {
  if (!rest.watches()) return;
  forces.markChanges(statistics.time, statistics.time + frameLength(), state.position, rest.disturbed());
  if (!pin_moves.empty()) rest.disturbAll();
  rest.approachedBy(obstacles);
  if (rest.wake()) takeOverSleepers();
}

// A frame in which nothing moves. Obstacles do, far away.
void Simulator::Impl::sleepThrough() {
  if (obstacles.anyMoved()) {
    obstacles.setSubstep(1.0, 1.0);
    ++revision;
  }
  obstacles.endFrame();
  ++frame;
  statistics.frames = frame;
  statistics.time = timeOf(frame);
  statistics.substeps_last = 0;
  statistics.sweeps_last = 0;
  ++statistics.asleep_frames;
}

// After a frame. Before it watches, nothing is about to fall asleep that gusts could keep awake.
void Simulator::Impl::fallAsleep() {
  if (!rest.due()) return;
  kept_awake.clear();
  if (rest.watches()) forces.markGusts(statistics.time, state.position, kept_awake);
  const bool leapfrogs = scene.solver.method == Method::kAuto || scene.solver.method == Method::kLeapfrog;
  const bool by_column = leapfrogs && estimate == nullptr;
  const Contacts* const contacts = contact.wanted() && contact.any() ? &contact.contacts() : nullptr;
  if (rest.look(state, made_time, kept_awake, contacts, by_column)) takeOverSleepers();
}

void Simulator::Impl::takeOverSleepers() {
  exact.hold(rest.asleep(), state);
  velocities_fresh = false;
  statistics.asleep = rest.asleep().count();
  statistics.wakes = rest.wakes();
  control.wake(exact);
  plain_control.wake(exact);
  if (!rest.asleep().full()) return;
  // Velocities half a substep old are old no more: all are zero.
  state.velocity_age = 0.0;
  companion.lost = true;  // starts from the motion when that goes on
}

void Simulator::Impl::wakeAll() {
  rest.disturbAll();
  if (rest.wake()) takeOverSleepers();
}

void Simulator::Impl::setRestLimits() {
  double speed = scene.solver.rest_speed;
  if (scene.solver.position_tolerance > 0.0) speed = std::min(speed, scene.solver.position_tolerance);
  rest.setLimits(speed, scene.gravity.norm(), forces.dampingPerMass(), scene.cloth.height);
}

}  // namespace curtain
