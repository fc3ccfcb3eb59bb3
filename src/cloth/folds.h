// SPDX-License-Identifier: BSD-3-Clause
//
// Second-layer nodes (Cheng 2000, Sect. 3.2, Fig. 9): the weft link between two first-layer nodes is k rods of equal
// length. Ends and length leave the shape of the fold open: we take equal turning at every joint (an arc of a regular
// polygon) in the plane of the link and its normal. The parity of the link's column decides the side of the bow, so
// folds run down the cloth as pleats, neighbours meet with a common tangent, and no side ever flips.
//
//        o--.        bow    k = 4        o   first-layer node
//       /    \        ^                  .   second-layer node
//      .      .       |
//     /        \   -- o ---> chord
#pragma once

#include <vector>

#include "cloth/cloth.h"

namespace curtain {

/// Position of one fold.
struct FoldArc {
  Vec3 first;         ///< first-layer node at the link's left end [m]
  Vec3 second;        ///< and at its right end [m]
  Vec3 bow;           ///< unit, perpendicular to the chord: direction of the bow
  double rest = 0.0;  ///< length of the link [m]
};

/// Places the k - 1 second-layer nodes of folds. Immutable: any number of threads may use it.
class FoldShape {
 public:
  /// rod_count  k, rods per weft link, >= 1
  explicit FoldShape(int rod_count);

  /// Writes the k - 1 inner nodes [m]. Rods have the length rest / k; if the link is taut or too long, the nodes divide
  /// the chord evenly.
  void place(const FoldArc& arc, Vec3* inner) const noexcept;

 private:
  double turning(double chord_ratio) const noexcept;

  int rod_count_;
  std::vector<double> table_;  // turning angle at even steps of sqrt(1 - chord ratio) in [0, 1]
};

/// The fold of the weft link that ends at (row, column); in closed cloth column 0 closes the ring. weft_rest: as in
/// ClothPattern; area_vectors: from nodeAreaVectors().
FoldArc foldArc(const Grid& grid, const Field& weft_rest, const Field3& position, const Field3& area_vectors, int row,
                int column);

}  // namespace curtain
