// SPDX-License-Identifier: BSD-3-Clause
//
// The public interface of what presses and pulls at the cloth: winds, drags, the air.
#include "simulator/simulator_impl.h"

namespace curtain {
namespace {

// They differ at most in start and end.
bool isSame(const WindParams& a, const WindParams& b) {
  return a.position == b.position && a.direction == b.direction && a.radius == b.radius &&
         a.half_angle == b.half_angle && a.pressure == b.pressure && a.node_force == b.node_force &&
         a.porosity_weight == b.porosity_weight && a.distance_weight == b.distance_weight &&
         a.reference_length == b.reference_length && a.unsteadiness == b.unsteadiness &&
         a.correlation_time == b.correlation_time && a.correlation_length == b.correlation_length &&
         a.profile == b.profile && a.shadow == b.shadow;
}

bool isSame(const DragParams& a, const DragParams& b) {
  const auto sameNode = [](const std::optional<NodeIndex>& p, const std::optional<NodeIndex>& q) {
    return p.has_value() == q.has_value() && (!p || (p->row == q->row && p->column == q->column));
  };
  return sameNode(a.node, b.node) && a.point == b.point && a.force == b.force && a.target == b.target &&
         a.stiffness == b.stiffness && a.max_force == b.max_force && a.radius == b.radius;
}

// An unchanged source that is given again continues: it keeps its start, so that nothing wakes. True: `given` does.
template <typename Params>
bool continues(const std::vector<Params>& known, double now, Params& given) {
  const Params* const old = findById(known, given.id);
  if (old == nullptr || !actsAt(*old, now) || !actsAt(given, now) || !isSame(*old, given)) return false;
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
  std::vector<Problem> problems = validate(given, im.scene.cloth, "drag");
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
