// SPDX-License-Identifier: BSD-3-Clause
#include "bench/engines/air.h"

#include "parts/air/air_damping.h"

namespace curtain_bench {

Air::Air(const curtain::Scene& scene) : scene_(scene), pattern_(curtain::makePattern(scene_)) {
  for (const curtain::WindParams& wind : scene_.wind)
    winds_.emplace_back(wind, pattern_, curtain::Layers(scene_), scene_.solver.seed);
  for (curtain::Field3* const field : {&position_, &area_vectors_, &force_}) field->assign(pattern_.grid.size(), 0.0);
}

void Air::accelerations(const Points& positions, const Points& velocities, double time, Points& out) {
  const curtain::Grid& grid = pattern_.grid;
  Eigen::AlignedBox3d box;
  std::size_t n = 0;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j, ++n) {
      const curtain::Vec3 place(positions.x[n], positions.y[n], positions.z[n]);
      position_.set(grid.index(i, j), place);
      box.extend(place);
    }
  }
  force_.assign(grid.size(), 0.0);
  curtain::nodeAreaVectors(grid, position_, area_vectors_);
  for (curtain::WindSource& wind : winds_) {
    if (!wind.blowsAt(time)) continue;
    wind.find(grid, position_, box);
    wind.addForces(pattern_, position_, area_vectors_, time, force_);
  }
  out.resize(positions.x.size());
  n = 0;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j, ++n) {
      const std::size_t at = grid.index(i, j);
      const curtain::Vec3 velocity(velocities.x[n], velocities.y[n], velocities.z[n]);
      const double slow = scene_.air.density * scene_.air.inside * pattern_.area[at];  // [kg/s]
      const double growth = curtain::dampingGrowth(scene_.air, velocity.norm());
      const curtain::Vec3 acceleration = pattern_.inverse_mass[at] * (force_.at(at) - slow * (growth - 1.0) * velocity);
      out.x[n] = acceleration.x();
      out.y[n] = acceleration.y();
      out.z[n] = acceleration.z();
    }
  }
}

}  // namespace curtain_bench
