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
  throw std::invalid_argument("hang.start." + key + ": " + text);
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
    refuse("file", error.what());
  }
  if (problem.empty()) problem = problemOfPiercings(*this, im.scene.obstacles);
  if (!problem.empty()) refuse("file", file + ": " + problem);
}

void Simulator::startOver(const std::string& name, const MeshResolver& resolve) {
  Impl& im = *impl_;
  const std::vector<ObstacleParams>& all = im.scene.obstacles;
  const auto is_it = [&](const ObstacleParams& params) { return params.name == name; };
  const auto number = static_cast<int>(std::find_if(all.begin(), all.end(), is_it) - all.begin());
  Scene settling = settlingScene(im.scene, im.motion.obstacles, number);
  Simulator resting(settling, resolve);
  std::string problem = problemOfPiercings(resting, all);
  if (!problem.empty()) refuse("over", problem + " where it is spread out, just above '" + name + "'");
  im.startAt(layOver(resting));
  problem = problemOfPiercings(*this, all);
  // No resting cloth is further from what it rests on than contact keeps it.
  const double farthest = 2.0 * im.scene.contact.thickness + all[static_cast<std::size_t>(number)].padding;
  if (problem.empty() && !(obstacleDistance(number).distance <= farthest)) problem = "the cloth slides off it";
  if (!problem.empty()) refuse("over", problem);
}

}  // namespace curtain
