// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/force_field.h"

#include <algorithm>
#include <optional>

namespace curtain {
namespace {

// An event on the border of two frames belongs to both, whatever the rounding [s].
constexpr double kTimeRounding = 1e-9;

bool within(double time, double from, double to) { return time >= from - kTimeRounding && time <= to + kTimeRounding; }

}  // namespace

ForceField::ForceField(const Scene& scene, const ClothPattern& pattern, Grasps* hands)
    : scene_(scene),
      pattern_(pattern),
      bounds_(pattern),
      air_damping_(scene.air, pattern),
      relative_air_(scene.air, scene.cloth.porosity, pattern),
      ambient_(scene.ambient),
      hands_(hands) {
  const std::size_t size = pattern.grid.size();
  weight_.assign(size, 0.0);
  takeGravity();
  area_vectors_.assign(size, 0.0);
  air_velocity_.assign(size, 0.0);
  sum_.assign(size, 0.0);
  forces_.damping.assign(size, 0.0);
  forces_.has_damping = air_damping_.active();
  reset();
}

void ForceField::reset() {
  winds_.clear();
  drags_.clear();
  for (const WindParams& wind : scene_.wind) setWind(wind);
  for (const DragParams& drag : scene_.drag) setDrag(drag);
  sum_.assign(pattern_.grid.size(), 0.0);
  forces_.force = &sum_;
}

void ForceField::takeGravity() noexcept {
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) weight_.set(n, pattern_.mass[n] * scene_.gravity);
}

void ForceField::takeAir() {
  air_damping_ = AirDamping(scene_.air, pattern_);
  relative_air_ = RelativeAir(scene_.air, scene_.cloth.porosity, pattern_);
}

double ForceField::dampingPerMass() const noexcept {
  if (!relative_air_.active()) return air_damping_.strongestPerMass(pattern_);
  double speed = ambient_.meanSpeed();
  for (const WindSource& wind : winds_.list) speed += wind.topSpeed(pattern_, relative_air_.density());
  return relative_air_.strongestPerMass(speed);
}

void ForceField::setWind(const WindParams& wind) {
  winds_.put(WindSource(wind, pattern_, scene_.cloth.porosity, scene_.solver.seed));
}

void ForceField::setDrag(const DragParams& drag) {
  DragForce force(drag, pattern_);
  const DragForce* const old = drags_.find(drag.id);
  // A drag that is replaced keeps its node, wherever the node has moved since.
  if (old != nullptr && !force.node() && old->node()) force.grasp(*old->node(), pattern_);
  drags_.put(std::move(force));
}

void ForceField::castShadows(const ObstacleSet& obstacles, const Field3& position, double from, double to) {
  for (WindSource& wind : winds_.list) {
    const bool blows = wind.params().start < to && wind.params().end > from;
    if (blows) shadow_.cast(obstacles, pattern_.grid, position, wind);
  }
}

// Finds the nodes that the active winds reach; false: none.
bool ForceField::findWinds(const Field3& position, double time) noexcept {
  std::optional<Eigen::AlignedBox3d> cloth;
  bool any = false;
  for (WindSource& wind : winds_.list) {
    if (!wind.blowsAt(time)) continue;
    if (!cloth) cloth = bounds_.around(position);
    wind.find(pattern_.grid, position, *cloth);
    any = any || wind.reaches();
  }
  return any;
}

void ForceField::addWinds(const Field3& position, double time) noexcept {
  for (int i = 0; i < pattern_.grid.rows; ++i) {
    const auto reads = [=](const WindSource& wind) {
      return wind.blowsAt(time) && wind.readsNormals() && wind.reachesRow(i);
    };
    if (std::any_of(winds_.list.begin(), winds_.list.end(), reads))
      nodeAreaVectors(pattern_.grid, i, position, area_vectors_);
  }
  for (WindSource& wind : winds_.list) {
    if (wind.blowsAt(time)) wind.addForces(pattern_, position, area_vectors_, time, sum_);
  }
}

void ForceField::addRelativeAir(const ClothState& state, double time, bool windy, const SubstepAhead& ahead) noexcept {
  nodeAreaVectors(pattern_.grid, state.position, area_vectors_);
  ambient_.setVelocities(pattern_.grid, state.position, time, air_velocity_);
  for (WindSource& wind : winds_.list) {
    if (windy && wind.blowsAt(time))
      wind.addVelocities(pattern_, state.position, time, relative_air_.density(), air_velocity_);
  }
  relative_air_.addForces(pattern_, area_vectors_, air_velocity_, state.velocity, ahead, sum_);
}

// A source that reaches nothing is left out: with weight alone the solver takes a shorter path.
const NodeForces& ForceField::evaluate(const ClothState& state, double time, double dt,
                                       const SubstepAhead& ahead) noexcept {
  const auto acts = [time](const DragForce& drag) { return drag.actsAt(time); };
  const bool windy = findWinds(state.position, time);
  const bool dragged = std::any_of(drags_.list.begin(), drags_.list.end(), acts);
  forces_.force = &weight_;
  const bool relative = relative_air_.active(), gives = hands_ != nullptr && hands_->anySprings();
  forces_.weight_only = !windy && !dragged && !relative && !gives;
  forces_.gravity = scene_.gravity;
  if (!forces_.weight_only) {
    sum_ = weight_;
    forces_.force = &sum_;
  }
  if (windy && !relative) addWinds(state.position, time);
  const auto damps = [&acts](const DragForce& drag) { return drag.damps() && acts(drag); };
  forces_.has_damping = air_damping_.active() || gives || std::any_of(drags_.list.begin(), drags_.list.end(), damps);
  if (forces_.has_damping) std::fill(forces_.damping.begin(), forces_.damping.end(), 0.0);
  if (air_damping_.active()) air_damping_.addCoefficients(pattern_.grid, state.velocity, forces_.damping);
  for (DragForce& drag : drags_.list) {
    if (acts(drag)) drag.addForces(pattern_, state.position, dt + state.velocity_age, sum_, forces_.damping);
  }
  if (gives && relative) hands_->keepForces(sum_);
  if (relative) addRelativeAir(state, time, windy, ahead);  // after the others: it reads the others
  if (gives && relative) hands_->restoreForces(sum_);
  if (gives) hands_->addForces(state, sum_, forces_.damping);
  return forces_;
}

bool sameWhileItBlows(const WindParams& a, const WindParams& b) {
  return a.position == b.position && a.direction == b.direction && a.radius == b.radius &&
         a.half_angle == b.half_angle && a.pressure == b.pressure && a.node_force == b.node_force &&
         a.porosity_weight == b.porosity_weight && a.distance_weight == b.distance_weight &&
         a.reference_length == b.reference_length && a.unsteadiness == b.unsteadiness &&
         a.correlation_time == b.correlation_time && a.correlation_length == b.correlation_length &&
         a.profile == b.profile && a.shadow == b.shadow;
}

bool sameWhileItActs(const DragParams& a, const DragParams& b) {
  const auto sameNode = [](const std::optional<NodeIndex>& p, const std::optional<NodeIndex>& q) {
    return p.has_value() == q.has_value() && (!p || (p->row == q->row && p->column == q->column));
  };
  const auto samePoint = [](const std::optional<Vec3>& p, const std::optional<Vec3>& q) {
    return p.has_value() == q.has_value() && (!p || *p == *q);
  };
  return sameNode(a.node, b.node) && samePoint(a.point, b.point) && a.force == b.force &&
         samePoint(a.target, b.target) && a.stiffness == b.stiffness && a.max_force == b.max_force &&
         a.radius == b.radius;
}

bool ForceField::isReachedBy(const WindSource& wind, const Field3& position) const noexcept {
  const Grid& grid = pattern_.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      if (wind.reachesPoint(position.at(grid.index(i, j)))) return true;
    }
  }
  return false;
}

bool ForceField::changesWithin(double from, double to, const Field3& position) const noexcept {
  const auto changes = [=](const auto& source) {
    return within(source.params().start, from, to) || within(source.params().end, from, to);
  };
  for (const DragForce& drag : drags_.list) {
    if (changes(drag)) return true;
  }
  for (const WindSource& wind : winds_.list) {
    if (changes(wind) && isReachedBy(wind, position)) return true;
  }
  return false;
}

bool ForceField::gustsAt(double time, const Field3& position) const noexcept {
  if (relative_air_.active() && ambient_.gusty()) return true;
  return std::any_of(winds_.list.begin(), winds_.list.end(), [&](const WindSource& wind) {
    return wind.params().unsteadiness > 0.0 && wind.blowsAt(time) && isReachedBy(wind, position);
  });
}

bool ForceField::shadowsMove(const ObstacleSet& obstacles, double time, const Field3& position) const noexcept {
  for (const WindSource& wind : winds_.list) {
    if (!wind.params().shadow || !wind.blowsAt(time)) continue;
    // One that has left the cone, or is gone, still has its shade there.
    bool changes = wind.shaded() && obstacles.anyMoved();
    for (int index = 0; index < obstacles.count() && !changes; ++index) {
      changes = obstacles.moved(index) && mayShade(obstacles, index, wind);
    }
    if (changes && isReachedBy(wind, position)) return true;
  }
  return false;
}

bool ForceField::windReaches(const std::string& id, const Field3& position) const noexcept {
  return std::any_of(winds_.list.begin(), winds_.list.end(),
                     [&](const WindSource& wind) { return wind.params().id == id && isReachedBy(wind, position); });
}

bool ForceField::reaches(const std::string& id, double time, const Field3& position) const {
  return std::any_of(winds_.list.begin(), winds_.list.end(), [&](const WindSource& wind) {
    return wind.params().id == id && wind.blowsAt(time) && isReachedBy(wind, position);
  });
}

}  // namespace curtain
