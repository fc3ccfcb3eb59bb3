// SPDX-License-Identifier: BSD-3-Clause
//
// Second-layer nodes (Cheng 2000, Sect. 3.2, Fig. 9): the weft link between two first-layer nodes is k rods of equal
// length. Ends and length leave the shape of the fold open; we take the one of equal turning at every joint (a
// regular polygon's arc), lying in the plane of the link and its normal. The side of the bow is the parity of the
// link's column, so folds run down the cloth as pleats, neighbours meet with one tangent, and no side ever flips.
//
//        o--.        bow    k = 4        o   first-layer node
//       /    \        ^                  .   second-layer node
//      .      .       |
//     /        \   -- o ---> chord
#pragma once

#include <vector>

#include "cloth/cloth.h"

namespace curtain {

/// Where one fold lies.
struct FoldArc {
  Vec3 first;         ///< first-layer node at the link's left end [m]
  Vec3 second;        ///< and at its right end [m]
  Vec3 bow;           ///< unit, perpendicular to the chord: the way the fold bows
  double rest = 0.0;  ///< length of the link [m]
};

/// Places the k - 1 second-layer nodes of folds. Immutable: any number of threads may use it.
class FoldShape {
 public:
  /// rod_count  k, rods per weft link, >= 1
  explicit FoldShape(int rod_count);

  int rodCount() const { return rod_count_; }

  /// Writes the k - 1 inner nodes [m]. Every rod has the length rest / k, but for a link that is taut or longer
  /// than its rest length: there they lie evenly on the chord.
  void place(const FoldArc& arc, Vec3* inner) const noexcept;

 private:
  double turning(double chord_ratio) const noexcept;

  int rod_count_;
  std::vector<double> table_;  // turning angle over sqrt(1 - chord ratio) in [0, 1], even spacing
};

/// The fold of the weft link that ends at (row, column) (closed cloth: column 0 closes the ring). area_vectors as
/// nodeAreaVectors gives them.
FoldArc foldArc(const ClothPattern& pattern, const Field3& position, const Field3& area_vectors, int row, int column);

}  // namespace curtain
