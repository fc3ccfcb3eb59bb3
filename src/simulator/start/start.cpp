// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth that starts elsewhere than hung by its edge: there a simulator is put, and goes back to at reset().
#include <algorithm>
#include <stdexcept>

#include "contact/oracle/obstacle_distance.h"
#include "contact/oracle/piercings.h"
#include "simulator/simulator_impl.h"
#include "simulator/start/laid_start.h"
#include "simulator/start/start_file.h"

namespace curtain {
namespace {

constexpr double kDepthTolerance = 1e-6;  // [m] of piercings

// Cloth that is put into an obstacle would stay in it. Empty: it goes through none.
std::string problemOfPiercings(const Simulator& simulator, const std::vector<ObstacleParams>& obstacles) {
  for (int k = 0; k < simulator.obstacleCount(); ++k) {
    const Piercings pierced = simulator.piercings(k, kDepthTolerance);
    if (pierced.nodes + pierced.edges + pierced.faces > 0)
      return "the cloth goes through the obstacle '" + obstacles[static_cast<std::size_t>(k)].name + "'";
  }
  return {};
}

[[noreturn]] void refuse(const std::string& key, const std::string& text) {
  throw std::invalid_argument(key + ": " + text);
}

}  // namespace

void Simulator::Impl::startAt(const std::vector<Vec3>& positions) {
  std::size_t from = 0;
  for (int i = 0; i < pattern.grid.rows; ++i) {
    for (int j = 0; j < pattern.grid.columns; ++j)
      motion.initial.position.set(pattern.grid.index(i, j), positions[from++]);
  }
  reset();
}

void Simulator::startFrom(const std::string& file, const MeshResolver& resolve) {
  Impl& im = *impl_;
  std::string problem;
  try {
    im.startAt(readStartFile(resolve(file), wholeCloth(im.scene)));
    problem = problemOfStart(im.scene, im.pattern, im.motion.state.position);
  } catch (const std::invalid_argument& error) {
    refuse("hang.start.file", error.what());
  }
  if (problem.empty()) problem = problemOfPiercings(*this, im.scene.obstacles);
  if (!problem.empty()) refuse("hang.start.file", file + ": " + problem);
}

void Simulator::layOver(const MeshResolver& resolve) {
  Impl& im = *impl_;
  const ObstacleSet& obstacles = im.motion.obstacles;
  const std::vector<Laid> laid = laidCloths(im.scene);
  Simulator resting(settlingScene(im.scene, obstacles, laid), resolve);
  std::string problem = problemOfPiercings(resting, im.scene.obstacles);
  const std::string& first = im.scene.obstacles[static_cast<std::size_t>(laid.front().obstacle)].name;
  if (!problem.empty()) refuse(laid.front().key, problem + " where it is spread out, just above '" + first + "'");
  // Others start where they hang.
  std::vector<Vec3> nodes, settled = settle(resting);
  copyPositions(nodes);
  for (const Laid& one : laid) {
    const Layers::Layer& columns = im.motion.parts.layers[one.layer];
    for (int i = 0; i < rows(); ++i) {
      for (int j = columns.first; j < columns.end; ++j) {
        const auto n = static_cast<std::size_t>(i * im.pattern.grid.columns + j);
        nodes[n] = settled[n];
      }
    }
  }
  im.startAt(nodes);
  problem = problemOfPiercings(*this, im.scene.obstacles);
  if (problem.empty() && im.scene.contact.self && selfCrossings() > 0) problem = "the cloth goes through itself";
  if (!problem.empty()) refuse(laid.front().key, problem);
  for (const Laid& one : laid) {
    // No resting cloth is further from what it rests on than contact keeps it.
    const double farthest = 2.0 * static_cast<double>(laid.size()) * im.scene.contact.thickness +
                            im.scene.obstacles[static_cast<std::size_t>(one.obstacle)].padding;
    if (!(im.distanceOf(one.layer, one.obstacle) <= farthest)) refuse(one.key, "the cloth slides off it");
  }
}

// Of one of the cloths from an obstacle [m].
double Simulator::Impl::distanceOf(std::size_t layer, int obstacle) const {
  const Layers::Layer& columns = motion.parts.layers[layer];
  const Grid grid(pattern.grid.rows, columns.end - columns.first, pattern.grid.closed);
  Field3 position;
  position.assign(grid.size(), 0.0);
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j)
      position.set(grid.index(i, j), motion.state.position.at(pattern.grid.index(i, columns.first + j)));
  }
  return distanceTo(motion.obstacles.shape(obstacle), Transform(motion.obstacles.reached(obstacle)), grid, position)
      .distance;
}

}  // namespace curtain
