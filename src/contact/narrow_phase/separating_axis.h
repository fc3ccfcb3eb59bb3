// SPDX-License-Identifier: BSD-3-Clause
//
// Separating axis tests over a straight motion, eight pairs at once. Along a fixed direction positions are linear in
// time: two convex sets that are further apart than the reach along it at the start, and on the same side at the end,
// were so throughout. Any direction that separates is a proof; each test tries a few likely ones. Pairs without a proof
// remain candidates.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace curtain {

/// Places of a node at both ends of its path [m]; the fourth lane is 0.
struct SweptNode {
  Eigen::Array4f start, end;
};

/// What is proved of the motion of these nodes is proved for `reach` [m]; rounding [m]: largest rounding error of a
/// difference of two coordinates.
struct StraightMotion {
  const SweptNode* nodes;
  float reach, rounding;
};

constexpr std::size_t kPairsAtOnce = 8;

/// Upper left nodes of two quads. Their other corners come next, and at the same places in the next row.
struct TwoQuads {
  std::uint32_t one, other;
};

/// Bit k is set where two quads are proved to stay further apart than the reach: along the direction between their
/// centres, or those of at most `steps` of Gilbert's iterations (1966) towards the closest points half way. stride:
/// between rows of nodes.
std::uint32_t quadsSeparated(const std::array<TwoQuads, kPairsAtOnce>& pairs, const StraightMotion& motion,
                             std::size_t stride, int steps) noexcept;

/// Two elements without a common node by their numbers in a cluster of nodes: a vertex and a triangle, or two edges.
using LocalPair = std::array<std::uint8_t, 4>;

/// Eight clusters of up to kMost nodes: the node at a number, of each.
struct Clusters {
  static constexpr std::size_t kMost = 9;
  std::array<std::array<std::uint32_t, kPairsAtOnce>, kMost> nodes;
  std::size_t size;  ///< nodes of each
};

/// Bit k of near[l] is set where pair l of cluster k, of the vertices and then of the edges, is not proved to stay
/// further apart than the reach, along the direction between the closest points half way: it separates nearly all pairs
/// that can be separated.
void findNear(const Clusters& clusters, const StraightMotion& motion, const std::vector<LocalPair>& vertices,
              const std::vector<LocalPair>& edges, std::uint8_t* near) noexcept;

}  // namespace curtain
