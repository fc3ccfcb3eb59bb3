// SPDX-License-Identifier: BSD-3-Clause
//
// A straight motion of all nodes in single precision, relative to an origin that moves with the cloth, so that rounding
// is small.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "cloth/cloth.h"
#include "contact/narrow_phase/separating_axis.h"

namespace curtain {

/// Not thread-safe.
class SweptNodes {
 public:
  using Floats = std::vector<float, CacheAligned<float>>;

  explicit SweptNodes(const Grid& grid);

  /// Positions at both ends of the motion [m], finite, of the grid's size. Allocates nothing.
  void set(const Field3& start, const Field3& end) noexcept;
  /// The same start and another end [m] than the one that set() was told, which is kept as the expected one.
  void setEnd(const Field3& end) noexcept;
  /// Takes the largest magnitude of a coordinate in start() and end() [m], for rounding().
  void setLargest(float largest) noexcept;
  /// Copies them to nodes().
  void interleave() noexcept;

  /// The cloth's grid as it is in the arrays below: in closed cloth rows begin elsewhere than in a Field.
  const Grid& grid() const noexcept { return grid_; }
  /// By component [m]: rows of nodes; closed cloth repeats its first two columns behind the last. A vector register may
  /// be loaded from any node.
  const std::array<Floats, 3>& start() const noexcept { return start_; }
  const std::array<Floats, 3>& end() const noexcept { return end_; }
  /// The end that set() was told, after setEnd().
  const std::array<Floats, 3>& expected() const noexcept { return expected_; }
  /// start() and end() by node, after interleave().
  const std::vector<SweptNode>& nodes() const noexcept { return nodes_; }
  /// Bound of the rounding error of a difference of two coordinates [m].
  float rounding() const noexcept { return rounding_; }

 private:
  void setComponents(const Field3& from, const Vec3& origin, std::array<Floats, 3>& to) const noexcept;
  double meanDifference(const Field& from, const Field& to) const noexcept;
  void interleaveOne(const std::array<Floats, 3>& from, Eigen::Array4f SweptNode::*to) noexcept;

  Grid grid_;
  std::size_t field_stride_;
  std::array<Floats, 3> start_, end_, expected_;
  bool deviates_ = false;  // setEnd() was called
  std::vector<SweptNode> nodes_;
  Vec3 origin_ = Vec3::Zero(), origin_at_end_ = Vec3::Zero();  // first node's start; that plus the mean motion [m]
  float rounding_ = 0.0f;
};

}  // namespace curtain
