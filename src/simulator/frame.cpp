// SPDX-License-Identifier: BSD-3-Clause
//
// A frame: the order in which the simulator's parts run.
#include <algorithm>

#include "simulator/simulator_impl.h"

namespace curtain {
namespace {

// Largest overlength at a frame's end with which links count as holding in the next one.
constexpr double kHold = 0.05;

}  // namespace

void Simulator::Impl::step() {
  const Budget::Clock::time_point begin = Budget::Clock::now();
  motion.statistics.time = times.begin();
  motion.obstacles.beginFrame(times.end());
  grasps.movePins(pins);
  sleep.wakeForFrame(pins.any() || grasps.anyMoves());
  if (sleep.asleep()) {
    sleepThrough();
    countTime(begin);
    return;
  }
  const double share = moveThrough(begin);
  const Budget::Clock::time_point tail_begin = Budget::Clock::now();
  endFrame(share);
  countTime(begin);
  if (!budget.any()) return;
  budget.endFrame(share, tail_begin, Budget::Clock::now());
  if (motion.statistics.step_seconds > budget.seconds()) ++motion.statistics.late_frames;
}

// A frame in which the cloth sleeps. Obstacles away from it may move.
void Simulator::Impl::sleepThrough() {
  Statistics& s = motion.statistics;
  if (motion.obstacles.anyMoved()) {
    motion.obstacles.setSubstep(1.0, 1.0);
    ++revision;
  }
  motion.obstacles.endFrame();
  nextFrame(0.0);
  s.substeps_last = 0;
  s.sweeps_last = 0;
  ++s.asleep_frames;
}

// Returns the share of the frame that was made.
double Simulator::Impl::moveThrough(Budget::Clock::time_point begin) {
  const Statistics& s = motion.statistics;
  motion.drive_impulse = 0.0;
  if (pins.settle(motion.state)) motion.forgetVelocities();
  guard.beginFrame(pins.any());
  const bool links_hold = !pins.any() && !grasps.any() && std::max(s.warp_stretch, s.weft_stretch) < kHold;
  motion.contact.beginFrame(links_hold);
  motion.forces.setLinksHold(links_hold);
  motion.forces.castShadows(motion.obstacles, motion.state.position, times.begin(), times.end());
  const bool first = times.frame() == 0;
  if (errors && first) errors->makePilotRuns();  // not limited by the budget
  budget.beginFrame(first ? Budget::Clock::now() : begin);
  pins.start(times.rate(), followingSpeed(scene), motion.state);
  if (grasps.any()) grasps.begin(motion.state, times.rate());
  if (errors) errors->beginFrame();
  return loop.make();
}

void Simulator::Impl::endFrame(double share) {
  Statistics& s = motion.statistics;
  guard.endFrame(pins.any());
  pins.stop(share == 1.0 && !loop.pinsWaited(), motion.state);
  if (share < 1.0) {
    ++s.shortened_frames;
    s.lost_time += (1.0 - share) * times.length();
  }
  if (errors) errors->endFrame(share);
  motion.lag.endFrame(share);
  nextFrame(share);
  ++revision;
  motion.measure();
  opening.measure(motion.state, s);
  s.drive_force = motion.drive_impulse / times.length();
  if (grasps.any()) endGrasps(share);
  if (!opening.isUnderWay(motion.state) && !motion.cords.closing(motion.state)) sleep.fallAsleep();
  if (errors && sleep.asleep()) errors->lose();
  s.stage_seconds = motion.clock.seconds();
}

void Simulator::Impl::endGrasps(double share) {
  if (grasps.end(share, motion.state)) repin([this] { grasps.letGoOfEnded(pins); });
}

void Simulator::Impl::nextFrame(double share) noexcept {
  times.next(share);
  motion.statistics.frames = times.frame();
  motion.statistics.time = times.begin();
}

void Simulator::Impl::countTime(Budget::Clock::time_point begin) {
  Statistics& s = motion.statistics;
  s.step_seconds = Budget::secondsSince(begin);
  s.step_seconds_max = std::max(s.step_seconds_max, s.step_seconds);
  s.step_seconds_sum += s.step_seconds;
}

}  // namespace curtain
