// SPDX-License-Identifier: BSD-3-Clause
//
// Changes by the user between frames: keys of the scene that may change, and the state of the cloth. Gravity and air:
// simulator.cpp.
#include <algorithm>
#include <string>

#include "simulator/simulator_impl.h"

namespace curtain {
namespace {

// Larger values [m, m/s] would lose the length of a link in squares of distances.
constexpr double kFarthest = 1e9;

void check(const std::vector<Vec3>& values, std::size_t count, const std::string& name,
           std::vector<Problem>& problems) {
  if (values.size() != count) {
    problems.push_back({name, "must have " + std::to_string(count) + " entries, has " + std::to_string(values.size())});
    return;
  }
  for (std::size_t n = 0; n < count; ++n) {
    if (values[n].cwiseAbs().maxCoeff() <= kFarthest && values[n].allFinite()) continue;
    problems.push_back({name + "[" + std::to_string(n) + "]", "must be finite and within [-1e9, 1e9]"});
    return;
  }
}

// Carriers to the nearest places that the gaps between them leave.
void putOnRail(const ClothPattern& pattern, ClothState& state) {
  const RailPattern& rail = pattern.rail;
  double least = 0.0;
  for (std::size_t k = 0; k < rail.size(); ++k, least += rail.gap) {
    const auto n = static_cast<std::size_t>(rail.columns[k]);
    const double most = rail.path.length() - rail.gap * static_cast<double>(rail.size() - 1 - k);
    const double after = k > 0 ? state.place[k - 1] + rail.gap : 0.0;
    state.place[k] = std::min(most, std::max(after, rail.path.nearest(state.position.at(n))));
    const RailPath::Place at = rail.path.at(state.place[k]);
    state.position.set(n, at.point);
    state.velocity.set(n, state.velocity.at(n).dot(at.tangent) * at.tangent);
  }
}

// A load goes along with the mean of its lines' nodes; tie-backs close from where their nodes are.
void carryCords(const ClothPattern& pattern, const ClothState& before, Cords& parts, ClothState& state) {
  const CordsPattern& cords = pattern.cords;
  for (const CordEnd& end : cords.ends) {
    if (!end.load) continue;
    const double share = 1.0 / static_cast<double>(end.last - end.first);
    Vec3 moved = Vec3::Zero(), velocity = Vec3::Zero();
    for (std::size_t c = end.first; c < end.last; ++c) {
      const std::size_t n = cords.cords[c].node;
      moved += share * (state.position.at(n) - before.position.at(n));
      velocity += share * state.velocity.at(n);
    }
    state.position.add(end.node, moved);
    state.velocity.set(end.node, velocity);
  }
  for (std::size_t k = 0; k < cords.loops.size(); ++k) parts.close(k, parts.closed(k), state);
}

}  // namespace

std::vector<Problem> Simulator::setFrameRate(double rate) {
  Impl& im = *impl_;
  SolverParams params = im.scene.solver;
  params.frame_rate = rate;
  std::vector<Problem> problems = validate(params, "solver");
  if (!problems.empty() || rate == im.scene.solver.frame_rate) return problems;
  im.times.setRate(rate);
  im.takeFrame();
  if (im.errors) im.errors->takeFrame();
  return problems;
}

void Simulator::Impl::takeFriction() noexcept {
  motion.obstacles.takeFriction(scene.contact.friction);
  motion.contact.takeFriction(scene.contact.friction);
}

void Simulator::Impl::takeStretchTolerance() noexcept {
  const double tolerance = scene.solver.stretch_tolerance;
  motion.exact.takeStretchTolerance(tolerance);
  motion.contact.takeStretchTolerance(tolerance);
  sleep.rest().takeStretchTolerance(tolerance);
}

void Simulator::Impl::takePositionTolerance() noexcept {
  if (errors) errors->takeTolerance(scene.solver.position_tolerance);
  sleep.takeLimits();
}

void Simulator::Impl::takeBudget() noexcept {
  budget.take(scene.solver.budget_ms);
  if (!budget.any()) controls.allowAll();
}

std::vector<Problem> Simulator::setFriction(double friction) {
  Impl& im = *impl_;
  ContactParams params = im.scene.contact;
  params.friction = friction;
  std::vector<Problem> problems = validate(params, "contact");
  if (!problems.empty() || friction == im.scene.contact.friction) return problems;
  im.scene.contact.friction = friction;
  im.takeFriction();
  im.sleep.rest().disturb();
  return problems;
}

std::vector<Problem> Simulator::setStretchTolerance(double tolerance) {
  Impl& im = *impl_;
  SolverParams params = im.scene.solver;
  params.stretch_tolerance = tolerance;
  std::vector<Problem> problems = validate(params, "solver");
  if (!problems.empty() || tolerance == im.scene.solver.stretch_tolerance) return problems;
  im.scene.solver.stretch_tolerance = tolerance;
  im.takeStretchTolerance();
  im.motion.contact.invalidateStart();
  im.sleep.rest().disturb();
  return problems;
}

std::vector<Problem> Simulator::setPositionTolerance(double tolerance) {
  Impl& im = *impl_;
  SolverParams params = im.scene.solver;
  params.position_tolerance = tolerance;
  std::vector<Problem> problems = validate(params, "solver");
  if (!problems.empty() || tolerance == im.scene.solver.position_tolerance) return problems;
  // The reference run has memory of its own, and is a part of snapshots.
  const bool asked = im.scene.solver.position_tolerance > 0.0;
  if (asked && tolerance == 0.0) return {{"solver.position_tolerance", "must stay above 0: the scene asks for one"}};
  if (!asked) return {{"solver.position_tolerance", "must stay 0: the scene asks for none"}};
  im.scene.solver.position_tolerance = tolerance;
  im.takePositionTolerance();
  return problems;
}

std::vector<Problem> Simulator::setBudget(double ms) {
  Impl& im = *impl_;
  SolverParams params = im.scene.solver;
  params.budget_ms = ms;
  std::vector<Problem> problems = validate(params, "solver");
  if (!problems.empty() || ms == im.scene.solver.budget_ms) return problems;
  im.scene.solver.budget_ms = ms;
  im.takeBudget();
  return problems;
}

std::vector<Problem> Simulator::setState(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities) {
  Impl& im = *impl_;
  const Grid& grid = im.pattern.grid;
  std::vector<Problem> problems;
  check(positions, grid.nodeCount(), "positions", problems);
  check(velocities, grid.nodeCount(), "velocities", problems);
  if (!problems.empty()) return problems;
  im.sleep.wake();
  Motion& motion = im.motion;
  const ClothState before = motion.state;
  std::size_t from = 0;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j, ++from) {
      const std::size_t n = grid.index(i, j);
      motion.state.position.set(n, positions[from]);
      motion.state.velocity.set(n, im.pattern.pinned[n] == kPinned ? Vec3::Zero() : velocities[from]);
    }
  }
  putOnRail(im.pattern, motion.state);
  motion.state.velocity_age = 0.0;
  motion.exact.reset();
  im.grasps.holdWhereTheyAre(motion.state);
  carryCords(im.pattern, before, motion.cords, motion.state);
  motion.contact.forget();
  motion.forgetVelocities();
  motion.measureStretch();
  im.opening.measure(motion.state, motion.statistics);
  im.guard.forget();
  if (im.errors) im.errors->lose();
  ++im.revision;
  return problems;
}

}  // namespace curtain
