// SPDX-License-Identifier: BSD-3-Clause
//
// Where the cloth can be, from where a few of its nodes are: no two nodes are further apart than the links between them
// are long.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "cloth/cloth.h"

namespace curtain {

/// Links may be this much longer while something goes wrong.
constexpr double kOverlong = 1.1;

/// A box around the cloth from some 30 of its nodes, however many it has.
class SampledBounds {
 public:
  explicit SampledBounds(const ClothPattern& pattern);

  /// Of the cloth at these positions [m]; too large by margin() at most.
  Eigen::AlignedBox3d around(const Field3& position) const noexcept;

  /// Furthest way of a sample [m]: a box around the start that is made larger by it holds the end, too.
  double farthest(const Field3& start, const Field3& end) const noexcept;

  double margin() const noexcept { return links_hold_ ? margin_ : 0.0; }

  /// False: links may be longer than kOverlong (pins pulled apart); boxes are then made from all nodes.
  void setLinksHold(bool hold) noexcept { links_hold_ = hold; }

 private:
  const std::vector<std::size_t>& nodes() const noexcept { return links_hold_ ? samples_ : all_; }

  std::vector<std::size_t> samples_, all_;
  double margin_ = 0.0;  // of the samples [m]
  bool links_hold_ = true;
};

}  // namespace curtain
