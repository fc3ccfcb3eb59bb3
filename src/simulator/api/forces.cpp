// SPDX-License-Identifier: BSD-3-Clause
//
// The public interface of what presses and pulls at the cloth: winds, drags, the air.
#include "scene/key_values.h"
#include "simulator/simulator_impl.h"

namespace curtain {
namespace {

template <typename Params>
bool differAtMostInTime(Params a, const Params& b) {
  a.start = b.start;
  a.end = b.end;
  return KeyValues(a) == KeyValues(b);
}

// An unchanged source that is given again continues: it keeps its start, so that nothing wakes. True: `given` does.
template <typename Params>
bool continues(const std::vector<Params>& known, double now, Params& given) {
  const Params* const old = findById(known, given.id);
  if (old == nullptr || !actsAt(*old, now) || !actsAt(given, now) || !differAtMostInTime(*old, given)) return false;
  given.start = old->start;
  return true;
}

// Before a wind of this id changes, and after it.
void disturbByWind(const std::string& id, const Motion& motion, Rest& rest) {
  if (rest.watches() && motion.parts.winds.reaches(id, motion.state.position)) rest.disturb();
}

}  // namespace

std::vector<Problem> Simulator::setWind(const WindParams& given) {
  std::vector<Problem> problems = validate(given, "wind");
  if (!problems.empty()) return problems;
  Impl& im = *impl_;
  Winds& winds = im.motion.parts.winds;
  WindParams wind = given;
  const bool changes = !continues(winds.params(), im.motion.statistics.time, wind);
  if (changes) disturbByWind(wind.id, im.motion, im.sleep.rest());
  winds.set(wind);
  if (changes) disturbByWind(wind.id, im.motion, im.sleep.rest());
  im.sleep.limitsChanged();  // the wind's speed may damp
  return problems;
}

bool Simulator::removeWind(const std::string& id) {
  disturbByWind(id, impl_->motion, impl_->sleep.rest());
  return impl_->motion.parts.winds.remove(id);
}

void Simulator::clearWinds() {
  if (!winds().empty()) impl_->sleep.rest().disturb();
  impl_->motion.parts.winds.clear();
}

const std::vector<WindParams>& Simulator::winds() const { return impl_->motion.parts.winds.params(); }

std::vector<Problem> Simulator::setDrag(const DragParams& given) {
  Impl& im = *impl_;
  std::vector<Problem> problems = validate(given, wholeCloth(im.scene), "drag");
  if (!problems.empty()) return problems;
  Drags& drags = im.motion.parts.drags;
  DragParams drag = given;
  if (!continues(drags.params(), im.motion.statistics.time, drag)) im.sleep.rest().disturb();
  drags.set(drag);
  return problems;
}

bool Simulator::removeDrag(const std::string& id) {
  const bool removed = impl_->motion.parts.drags.remove(id);
  if (removed) impl_->sleep.rest().disturb();
  return removed;
}

void Simulator::clearDrags() {
  if (!drags().empty()) impl_->sleep.rest().disturb();
  impl_->motion.parts.drags.clear();
}

const std::vector<DragParams>& Simulator::drags() const { return impl_->motion.parts.drags.params(); }

NodeIndex Simulator::nearestNode(const Vec3& point) const {
  return curtain::nearestNode(impl_->pattern.grid, impl_->motion.state.position, point);
}

std::vector<Problem> Simulator::setAir(const AirParams& air) {
  Impl& im = *impl_;
  Scene with_air = im.scene;
  with_air.air = air;
  std::vector<Problem> problems = validate(with_air);  // not every method and wind goes with every law
  if (!problems.empty()) return problems;
  im.motion.velocities();  // as in setGravity()
  im.scene.air = air;
  im.keysChanged();
  im.sleep.rest().disturb();
  return problems;
}

}  // namespace curtain
