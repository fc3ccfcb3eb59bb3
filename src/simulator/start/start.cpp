// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth that starts elsewhere than hung by its edge: there a simulator is put, and goes back to at reset().
#include <algorithm>
#include <stdexcept>

#include "contact/oracle/piercings.h"
#include "simulator/simulator_impl.h"
#include "simulator/start/laid_start.h"
#include "simulator/start/start_file.h"

namespace curtain {

void Simulator::Impl::startAt(const std::vector<Vec3>& positions) {
  std::size_t from = 0;
  for (int i = 0; i < pattern.grid.rows; ++i) {
    for (int j = 0; j < pattern.grid.columns; ++j)
      motion.initial.position.set(pattern.grid.index(i, j), positions[from++]);
  }
  reset();
}

void Simulator::Impl::startFrom(const std::string& file, const MeshResolver& resolve) {
  const auto refuse = [](const std::string& text) { throw std::invalid_argument("hang.start.file: " + text); };
  try {
    startAt(readStartFile(resolve(file), scene.cloth));
  } catch (const std::invalid_argument& error) {
    refuse(error.what());
  }
  const std::string problem = problemOfStart(scene, pattern, motion.state.position);
  if (!problem.empty()) refuse(file + ": " + problem);
  for (int k = 0; k < motion.obstacles.count(); ++k) {
    const Piercings piercings = countPiercings(motion.obstacles.shape(k), Transform(motion.obstacles.reached(k)),
                                               pattern.grid, motion.state.position, 1e-6);
    if (piercings.nodes + piercings.edges + piercings.faces > 0)
      refuse(file + ": the cloth goes through the obstacle '" + scene.obstacles[static_cast<std::size_t>(k)].name +
             "'");
  }
}

void Simulator::Impl::startOver(const std::string& obstacle, const MeshResolver& resolve) {
  const auto found = std::find_if(scene.obstacles.begin(), scene.obstacles.end(),
                                  [&](const ObstacleParams& params) { return params.name == obstacle; });
  const auto number = static_cast<int>(found - scene.obstacles.begin());
  const Eigen::AlignedBox3d bounds = motion.obstacles.shape(number).bounds();
  const Transform place(motion.obstacles.reached(number));
  Eigen::AlignedBox3d box(bounds.min(), bounds.max());
  if (bounds.sizes().allFinite()) {
    const Vec3 half = place.rotation.cwiseAbs() * (0.5 * bounds.sizes());
    box = {place.toWorld(bounds.center()) - half, place.toWorld(bounds.center()) + half};
  }
  Simulator resting(settlingScene(scene, box), resolve);
  startAt(layOver(resting));
}

}  // namespace curtain
