// SPDX-License-Identifier: BSD-3-Clause
//
// Changes by the user between frames: frame rate and state of the cloth.
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

std::vector<Problem> Simulator::setState(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities) {
  Impl& im = *impl_;
  const Grid& grid = im.pattern.grid;
  std::vector<Problem> problems;
  check(positions, grid.nodeCount(), "positions", problems);
  check(velocities, grid.nodeCount(), "velocities", problems);
  if (!problems.empty()) return problems;
  im.sleep.wakeAll();
  Motion& motion = im.motion;
  std::size_t from = 0;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j, ++from) {
      const std::size_t n = grid.index(i, j);
      motion.state.position.set(n, positions[from]);
      motion.state.velocity.set(n, im.pattern.pinned[n] != 0 ? Vec3::Zero() : velocities[from]);
    }
  }
  motion.state.velocity_age = 0.0;
  motion.exact.reset();
  motion.contact.forget();
  motion.forgetVelocities();
  motion.measureStretch();
  im.guard.forget();
  if (im.errors) im.errors->lose();
  ++im.revision;
  return problems;
}

}  // namespace curtain
