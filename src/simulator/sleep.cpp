// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/sleep.h"

namespace curtain {

Sleep::Sleep(Motion& motion) : motion_(motion), rest_(motion.scene, motion.pattern) { limitsChanged(); }

void Sleep::wakeForFrame() {
  if (!rest_.watches()) return;
  const double now = motion_.statistics.time;
  const FrameBegin begin{now, now + motion_.times.length(), motion_.times.rate(), true};
  if (motion_.parts.all.any([&](const Part& part) { return part.wakes(begin, motion_.state); })) rest_.disturb();
  rest_.approachedBy(motion_.obstacles);
  if (rest_.wake()) restChanged();
}

void Sleep::wake() {
  rest_.disturb();
  if (rest_.wake()) restChanged();
}

// What keeps it awake matters only to cloth that may fall asleep soon, so not before rest_ watches. Cloth whose
// substeps were stopped stands, but does not rest.
void Sleep::fallAsleep() {
  const ClothState& state = motion_.state;
  const PartList& parts = motion_.parts.all;
  if (parts.any([&](const Part& part) { return part.isUnderWay(state); }) || !rest_.due()) return;
  const double now = motion_.statistics.time;
  const bool kept = motion_.statistics.stops_last > 0 ||
                    (rest_.watches() && parts.any([&](const Part& part) { return part.keepsAwake(state, now); }));
  const Contacts* const contacts = motion_.pushing();
  const bool touches = contacts != nullptr && anyPushes(*contacts);
  if (!rest_.check(state, motion_.times.madeTime(), kept, touches)) return;
  motion_.state.velocity.assign(motion_.pattern.grid.size(), 0.0);
  motion_.state.velocity_age = 0.0;  // velocities of zero lag behind nothing
  restChanged();
}

void Sleep::restChanged() {
  motion_.forgetVelocities();
  motion_.statistics.asleep = rest_.asleep();
  motion_.statistics.wakes = rest_.wakes();
}

void Sleep::limitsChanged() noexcept {
  double damping = 0.0, air_speed = 0.0;
  for (const Part* const part : motion_.parts.all) damping += part->dampingPerMass(air_speed);
  rest_.setLimits(damping);
}

}  // namespace curtain
