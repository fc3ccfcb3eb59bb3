// SPDX-License-Identifier: BSD-3-Clause
//
// Coarse grid of distances over the bounds of a mesh. A distance is 1-Lipschitz, so the value at the centre c of a cell
// bounds it at any p:  d(c) - |p - c| <= d(p) <= d(c) + |p - c|.
// One look-up settles most nodes far away or deep inside, and bounds the search in the tree for all others.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "curtain_sim/obstacle_shape.h"

namespace curtain {

class DistanceGrid {
 public:
  struct Bracket {
    double low;   ///< [m]
    double high;  ///< [m]
  };

  /// Distance of a point [m] (signed or not); the second argument is an upper bound for its magnitude [m].
  using Distance = std::function<double(const Vec3& point, double bound)>;

  /// About `cell_count` cubic cells over `bounds` [m], each filled by one call of `distance`.
  DistanceGrid(const Eigen::AlignedBox3d& bounds, double cell_count, const Distance& distance);

  /// Bounds of the distance at a point [m]; NaN where that is not finite.
  Bracket bracket(const Vec3& point) const noexcept {
    std::array<int, 3> cell;
    for (int i = 0; i < 3; ++i) {
      const double steps = (point[i] - low_[i]) / cell_size_;
      const auto axis = static_cast<std::size_t>(i);
      const double last = counts_[axis] - 1;
      cell[axis] = static_cast<int>(std::min(std::max(0.0, steps), last));  // in this order NaN becomes 0
    }
    const double distance = static_cast<double>(distances_[index(cell)]);
    const double away = (point - centre(cell)).norm() + margin_;
    const double beyond = (low_ - point).cwiseMax(point - high_).cwiseMax(0.0).norm();  // distance to the bounds
    return {beyond > 0.0 ? std::max(distance - away, beyond) : distance - away, distance + away};
  }

 private:
  std::size_t index(const std::array<int, 3>& cell) const noexcept {
    return (static_cast<std::size_t>(cell[2]) * static_cast<std::size_t>(counts_[1]) +
            static_cast<std::size_t>(cell[1])) *
               static_cast<std::size_t>(counts_[0]) +
           static_cast<std::size_t>(cell[0]);
  }
  Vec3 centre(const std::array<int, 3>& cell) const noexcept {
    return low_ + cell_size_ * Vec3(cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5);
  }

  Vec3 low_;
  Vec3 high_;
  double cell_size_ = 1.0;  // [m]
  double margin_ = 0.0;     // rounding of the stored distances [m]
  std::array<int, 3> counts_ = {1, 1, 1};
  std::vector<float> distances_;
};

inline DistanceGrid::DistanceGrid(const Eigen::AlignedBox3d& bounds, double cell_count, const Distance& distance)
    : low_(bounds.min()), high_(bounds.max()) {
  const Vec3 sizes = bounds.sizes();
  // A flat mesh has no volume: its short sides count as a hundredth of the longest.
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
        bound = (std::abs(value) + cell_size_) * (1.0 + 1e-9);  // Lipschitz bound for the next cell
      }
    }
  }
  // Half an ulp of a float is 6e-8 of its value; coordinates far from zero round in double precision.
  margin_ = 1e-7 * (largest + cell_size_) + 1e-14 * low_.cwiseAbs().maxCoeff();
}

}  // namespace curtain
