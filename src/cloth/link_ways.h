// SPDX-License-Identifier: BSD-3-Clause
//
// Bounds of the cloth from a few sampled nodes: no two nodes are further apart than the length of the links between
// them.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "cloth/cloth.h"

namespace curtain {

/// Factor on link lengths that allows for links that are temporarily too long.
constexpr double kOverlong = 1.1;

/// A bounding box of the cloth from about 30 of its nodes, however many it has.
class SampledBounds {
 public:
  explicit SampledBounds(const ClothPattern& pattern);

  /// Box of the cloth at these positions [m]; too large by margin() at most.
  Eigen::AlignedBox3d around(const Field3& position) const noexcept;

  /// Largest displacement of a sample [m]: the start's box enlarged by it contains the end.
  double farthest(const Field3& start, const Field3& end) const noexcept;

  double margin() const noexcept { return links_hold_ ? margin_ : 0.0; }

  /// False: links may exceed kOverlong (pins pulled apart), so boxes use all nodes.
  void setLinksHold(bool hold) noexcept { links_hold_ = hold; }

 private:
  const std::vector<std::size_t>& nodes() const noexcept { return links_hold_ ? samples_ : all_; }

  std::vector<std::size_t> samples_, all_;
  double margin_ = 0.0;  // around the samples [m]
  bool links_hold_ = true;
};

}  // namespace curtain
