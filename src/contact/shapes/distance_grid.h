// SPDX-License-Identifier: BSD-3-Clause
//
// Coarse grid of distances over the bounds of a mesh. A distance changes by no more than one walks, so the value
// at the centre c of a cell brackets it at any p:  d(c) - |p - c| <= d(p) <= d(c) + |p - c|.
// Most nodes that are far away, or deep inside, are told by this one look-up, and all others get a bound
// for the search in the tree.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
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

  /// Bounds of the distance at any finite point [m].
  Bracket bracket(const Vec3& point) const noexcept {
    std::array<int, 3> cell;
    for (int i = 0; i < 3; ++i) {
      const double steps = (point[i] - low_[i]) / cell_size_;
      const auto axis = static_cast<std::size_t>(i);
      cell[axis] = static_cast<int>(std::clamp(steps, 0.0, static_cast<double>(counts_[axis] - 1)));
    }
    const double distance = static_cast<double>(distances_[index(cell)]);
    const double away = (point - centre(cell)).norm() + margin_;
    const double beyond = (low_ - point).cwiseMax(point - high_).cwiseMax(0.0).norm();  // out of the bounds
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
  double margin_ = 0.0;     // of the distances kept in single precision [m]
  std::array<int, 3> counts_ = {1, 1, 1};
  std::vector<float> distances_;
};

}  // namespace curtain
