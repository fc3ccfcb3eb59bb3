// SPDX-License-Identifier: BSD-3-Clause
#include "contact/shapes/distance_grid.h"

#include <limits>

namespace curtain {

DistanceGrid::DistanceGrid(const Eigen::AlignedBox3d& bounds, double cell_count, const Distance& distance)
    : low_(bounds.min()), high_(bounds.max()) {
  const Vec3 sizes = bounds.sizes();
  // A flat mesh has no volume to divide: its short sides count as a hundredth of the longest.
  const Vec3 thick = sizes.cwiseMax(0.01 * sizes.maxCoeff());
  cell_size_ = std::cbrt(thick.prod() / cell_count);
  for (int i = 0; i < 3; ++i) {
    counts_[static_cast<std::size_t>(i)] = std::max(1, static_cast<int>(std::ceil(sizes[i] / cell_size_)));
  }
  distances_.resize(static_cast<std::size_t>(counts_[0]) * static_cast<std::size_t>(counts_[1]) *
                    static_cast<std::size_t>(counts_[2]));
  double largest = 0.0;
  std::array<int, 3> cell;
  for (cell[2] = 0; cell[2] < counts_[2]; ++cell[2]) {
    for (cell[1] = 0; cell[1] < counts_[1]; ++cell[1]) {
      double bound = std::numeric_limits<double>::infinity();
      for (cell[0] = 0; cell[0] < counts_[0]; ++cell[0]) {
        const double value = distance(centre(cell), bound);
        distances_[index(cell)] = static_cast<float>(value);
        largest = std::max(largest, std::abs(value));
        bound = (std::abs(value) + cell_size_) * (1.0 + 1e-9);  // the next cell is one cell further
      }
    }
  }
  // Half a unit in the last place of a float is 6e-8 of its value; coordinates far from zero round in double.
  margin_ = 1e-7 * (largest + cell_size_) + 1e-14 * low_.cwiseAbs().maxCoeff();
}

}  // namespace curtain
