// SPDX-License-Identifier: BSD-3-Clause
//
// Changes by the user between frames: keys of the scene that may change, and the state of the cloth.
#include <algorithm>
#include <string>

#include "scene/ranges.h"
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

// Sets a value of the scene. False: it has it already, or can't have it.
template <typename Params>
bool change(Params& params, double Params::*key, double value, const char* name, std::vector<Problem>& problems) {
  Params changed = params;
  changed.*key = value;
  problems = validate(changed, name);
  if (!problems.empty() || value == params.*key) return false;
  params = changed;
  return true;
}

}  // namespace

std::vector<Problem> Simulator::setFrameRate(double rate) {
  Impl& im = *impl_;
  SolverParams solver = im.scene.solver;
  std::vector<Problem> problems;
  if (!change(solver, &SolverParams::frame_rate, rate, "solver", problems)) return problems;
  im.times.setRate(rate);
  im.keysChanged();
  if (im.errors) im.errors->frameLengthChanged();
  return problems;
}

std::vector<Problem> Simulator::setFriction(double friction) {
  Impl& im = *impl_;
  std::vector<Problem> problems;
  if (!change(im.scene.contact, &ContactParams::friction, friction, "contact", problems)) return problems;
  im.keysChanged();
  im.sleep.rest().disturb();
  return problems;
}

std::vector<Problem> Simulator::setStretchTolerance(double tolerance) {
  Impl& im = *impl_;
  std::vector<Problem> problems;
  if (!change(im.scene.solver, &SolverParams::stretch_tolerance, tolerance, "solver", problems)) return problems;
  im.keysChanged();
  im.motion.contact.invalidateStart();
  im.sleep.rest().disturb();
  return problems;
}

std::vector<Problem> Simulator::setPositionTolerance(double tolerance) {
  Impl& im = *impl_;
  SolverParams solver = im.scene.solver;
  std::vector<Problem> problems;
  if (!change(solver, &SolverParams::position_tolerance, tolerance, "solver", problems)) return problems;
  // The reference run has memory of its own, and is a part of snapshots.
  const bool asked = im.scene.solver.position_tolerance > 0.0;
  if (asked && tolerance == 0.0) return {{"solver.position_tolerance", "must stay above 0: the scene asks for one"}};
  if (!asked) return {{"solver.position_tolerance", "must stay 0: the scene asks for none"}};
  im.scene.solver.position_tolerance = tolerance;
  im.keysChanged();
  return problems;
}

std::vector<Problem> Simulator::setBudget(double ms) {
  std::vector<Problem> problems;
  if (change(impl_->scene.solver, &SolverParams::budget_ms, ms, "solver", problems)) impl_->keysChanged();
  return problems;
}

std::vector<Problem> Simulator::setGravity(const Vec3& gravity) {
  const Range range = anywhere();
  const bool good = range.contains(gravity.x()) && range.contains(gravity.y()) && range.contains(gravity.z());
  if (!good) return {{"gravity", "must be 3 times " + range.text()}};
  Impl& im = *impl_;
  if (gravity == im.scene.gravity) return {};
  im.motion.velocities();  // caches them while the forces that made them are known
  im.scene.gravity = gravity;
  im.keysChanged();
  im.driven();
  return {};
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
  motion.state.velocity_age = 0.0;
  motion.step.reset();
  for (Part* const part : motion.parts.all) part->placed(before, motion.state);
  motion.contact.forget();
  motion.forgetVelocities();
  motion.measureState();
  im.motion.step.account().leaveOpen();
  if (im.errors) im.errors->lose();
  ++im.revision;
  return problems;
}

}  // namespace curtain
