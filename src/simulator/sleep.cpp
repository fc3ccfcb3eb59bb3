// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/sleep.h"

#include <algorithm>

namespace curtain {

Sleep::Sleep(Motion& motion)
    : motion_(motion),
      rest_(motion.pattern, motion.times.length(), motion.scene.contact.thickness,
            motion.scene.solver.stretch_tolerance) {
  takeLimits();
}

void Sleep::disturbByWind(const std::string& id) noexcept {
  if (rest_.watches() && motion_.forces.windReaches(id, motion_.state.position)) rest_.disturb();
}

void Sleep::wakeForFrame(bool pins_move) {
  if (!rest_.watches()) return;
  const double now = motion_.statistics.time;
  const Field3& position = motion_.state.position;
  if (pins_move || motion_.forces.changesWithin(now, now + motion_.times.length(), position) ||
      motion_.forces.shadowsMove(motion_.obstacles, now, position))
    rest_.disturb();
  rest_.approachedBy(motion_.obstacles);
  if (rest_.wake()) takeOver();
}

void Sleep::wake() {
  rest_.disturb();
  if (rest_.wake()) takeOver();
}

// Gusts matter only to cloth that may fall asleep soon, so not before rest_ watches.
void Sleep::fallAsleep() {
  if (!rest_.due()) return;
  const bool gusts = rest_.watches() && motion_.forces.gustsAt(motion_.statistics.time, motion_.state.position);
  const Contacts* const contacts = motion_.pushing();
  const bool touches = contacts != nullptr && anyPushes(*contacts);
  if (!rest_.look(motion_.state, motion_.times.madeTime(), gusts, touches)) return;
  motion_.state.velocity.assign(motion_.pattern.grid.size(), 0.0);
  motion_.state.velocity_age = 0.0;  // velocities of zero lag behind nothing
  takeOver();
}

void Sleep::takeOver() {
  motion_.forgetVelocities();
  motion_.statistics.asleep = rest_.asleep();
  motion_.statistics.wakes = rest_.wakes();
}

void Sleep::takeLimits() noexcept {
  const Scene& scene = motion_.scene;
  double speed = scene.solver.rest_speed;
  if (scene.solver.position_tolerance > 0.0) speed = std::min(speed, scene.solver.position_tolerance);
  rest_.takeFrame(motion_.times.length());
  rest_.setLimits(speed, scene.gravity.norm(), motion_.forces.dampingPerMass(), scene.cloth.height);
}

}  // namespace curtain
