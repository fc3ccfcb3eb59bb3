// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/sleep.h"

#include <algorithm>

namespace curtain {

Sleep::Sleep(Motion& motion, StepControls& controls, bool by_column)
    : motion_(motion),
      controls_(controls),
      by_column_(by_column),
      rest_(motion.pattern, motion.times.length(), motion.scene.contact.thickness,
            motion.scene.solver.stretch_tolerance),
      kept_awake_(motion.pattern.grid.columns) {
  takeLimits();
  motion_.exact.hold(rest_.asleep(), motion_.state);
}

void Sleep::reset() {
  rest_.forget();
  motion_.exact.hold(rest_.asleep(), motion_.state);
}

void Sleep::wakeForFrame(bool pins_move) {
  if (!rest_.watches()) return;
  const double now = motion_.statistics.time;
  motion_.forces.markChanges(now, now + motion_.times.length(), motion_.state.position, rest_.disturbed());
  motion_.forces.markShadows(motion_.obstacles, now, motion_.state.position, rest_.disturbed());
  if (pins_move) rest_.disturbAll();
  rest_.approachedBy(motion_.obstacles);
  if (rest_.wake()) takeOver();
}

void Sleep::wakePulled() {
  if (rest_.wakeFor(motion_.exact.held().disturbed(), motion_.times.madeTime())) takeOver();
}

void Sleep::wakeAll() {
  rest_.disturbAll();
  if (rest_.wake()) takeOver();
}

// Gusts matter only to columns that may fall asleep soon, so not before rest_ watches.
void Sleep::fallAsleep(bool as_a_whole) {
  if (!rest_.due()) return;
  kept_awake_.clear();
  if (rest_.watches()) motion_.forces.markGusts(motion_.statistics.time, motion_.state.position, kept_awake_);
  if (rest_.look(motion_.state, motion_.times.madeTime(), kept_awake_, motion_.pushing(), by_column_ && !as_a_whole)) {
    takeOver();
  }
}

void Sleep::takeOver() {
  motion_.exact.hold(rest_.asleep(), motion_.state);
  motion_.forgetVelocities();
  motion_.statistics.asleep = rest_.asleep().count();
  motion_.statistics.wakes = rest_.wakes();
  controls_.wake(motion_.exact);
  // All velocities are zero, so they lag behind nothing.
  if (all()) motion_.state.velocity_age = 0.0;
}

void Sleep::takeLimits() noexcept {
  const Scene& scene = motion_.scene;
  double speed = scene.solver.rest_speed;
  if (scene.solver.position_tolerance > 0.0) speed = std::min(speed, scene.solver.position_tolerance);
  rest_.takeFrame(motion_.times.length());
  rest_.setLimits(speed, scene.gravity.norm(), motion_.forces.dampingPerMass(), scene.cloth.height);
}

}  // namespace curtain
