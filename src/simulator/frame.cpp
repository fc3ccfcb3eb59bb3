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
  sleep.wakeForFrame();
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
  s.momentum_cut_last = 0.0;
  s.quality = FrameQuality::kResolved;
  ++s.asleep_frames;
}

// Returns the share of the frame that was made.
double Simulator::Impl::moveThrough(Budget::Clock::time_point begin) {
  const Statistics& s = motion.statistics;
  const PartList& parts = motion.parts.all;
  FrameBegin frame{times.begin(), times.end(), times.rate(), true};
  if (parts.any([&](const Part& part) { return part.begins(frame); })) {
    changePins([&] {
      for (Part* const part : parts) part->begun(frame, motion.state);
    });
  }
  const bool strained = parts.any([](const Part& part) { return part.strains(); });
  frame.links_hold = !strained && std::max(s.warp_stretch, s.weft_stretch) < kHold;
  for (Part* const part : parts) {
    if (part->prepareFrame(frame, motion.state)) motion.forgetVelocities();
  }
  closed.beginFrame();
  motion.contact.beginFrame(frame.links_hold);
  const bool first = times.frame() == 0;
  if (errors && first) errors->makePilotRuns();  // not limited by the budget
  budget.beginFrame(first ? Budget::Clock::now() : begin);
  bool repins = false;
  for (Part* const part : parts) repins = part->beginFrame(frame, motion.state) || repins;
  if (repins) changePins([] {});
  if (errors) errors->beginFrame();
  return loop.make();
}

void Simulator::Impl::endFrame(double share) {
  Statistics& s = motion.statistics;
  closed.endFrame();
  const FrameEnd frame{share, times.length(), share == 1.0 && !loop.pinsWaited(), s};
  bool repins = false;
  for (Part* const part : motion.parts.all) repins = part->endFrame(frame, motion.state) || repins;
  if (share < 1.0) {
    ++s.shortened_frames;
    s.lost_time += (1.0 - share) * times.length();
  }
  if (errors) errors->endFrame(share);
  motion.lag.endFrame(share);
  nextFrame(share);
  ++revision;
  motion.measure();
  if (repins) changePins([] {});
  sleep.fallAsleep();
  if (errors && sleep.asleep()) errors->lose();
  s.stage_seconds = motion.clock.seconds();
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
