// SPDX-License-Identifier: BSD-3-Clause
//
// The discrete elastic line (Hencky 1920): a line of links whose joints turn against springs. A strip of rigidity B [N
// m] and of a width stores B / 2 curvature^2 per length and width; a joint that turns by theta stands for the curvature
// theta / l over the length l between the middles of its links, so k = B width / l. A link between two pins is clamped
// and bends nowhere: its half does not count, and the line begins at the clamp's end.
#include "cloth/cloth.h"

namespace curtain {
namespace {

// Of the lines of one direction: links to the nodes before and after, and half the links across.
struct Joint {
  double before, after;  // lengths that can bend [m]; 0: there is no link, or it is clamped
  bool between;          // two links meet here
  double width;          // [m]
};

double lengthOf(const Joint& joint) { return 0.5 * (joint.before + joint.after); }

double stiffnessOf(const Joint& joint, double rigidity) {
  const double length = lengthOf(joint);
  return joint.between && length > 0.0 ? rigidity * joint.width / length : 0.0;
}

// The neighbours of a node along either direction; closed cloth has no ends along the weft, a slit makes some.
class Neighbours {
 public:
  explicit Neighbours(const ClothPattern& pattern) : pattern_(pattern), grid_(pattern.grid) {}

  Joint alongWarp(int i, int j) const {
    const double above = i > 0 ? bends(i - 1, j, i, j, warp(i, j)) : 0.0;
    const double below = i + 1 < grid_.rows ? bends(i, j, i + 1, j, warp(i + 1, j)) : 0.0;
    return {above, below, i > 0 && i + 1 < grid_.rows, 0.5 * (weft(i, j) + weft(i, rightOf(j)))};
  }
  Joint alongWeft(int i, int j) const {
    const int left = j > 0 ? j - 1 : grid_.columns - 1, right = rightOf(j);
    return {bends(i, left, i, j, weft(i, j)), bends(i, j, i, right, weft(i, right)),
            grid_.hasLink(i, j) && grid_.hasLink(i, right),
            0.5 * ((i > 0 ? warp(i, j) : 0.0) + (i + 1 < grid_.rows ? warp(i + 1, j) : 0.0))};
  }

 private:
  double warp(int i, int j) const { return pattern_.warp_rest[grid_.index(i, j)]; }
  // The link on the left of column j; 0: there is none.
  double weft(int i, int j) const { return grid_.hasLink(i, j) ? pattern_.weft_rest[grid_.index(i, j)] : 0.0; }
  int rightOf(int j) const { return j + 1 < grid_.columns ? j + 1 : 0; }
  double bends(int i, int j, int to_i, int to_j, double rest) const {
    return pattern_.isPinned({i, j}) && pattern_.isPinned({to_i, to_j}) ? 0.0 : rest;
  }

  const ClothPattern& pattern_;
  const Grid& grid_;
};

}  // namespace

void fillBending(const Layers& layers, ClothPattern& pattern) {
  const Grid& grid = pattern.grid;
  const Neighbours neighbours(pattern);
  const bool warp = layers.anyFabric([](const Fabric& fabric) { return fabric.bending_warp > 0.0; });
  const bool weft = layers.anyFabric([](const Fabric& fabric) { return fabric.bending_weft > 0.0; });
  pattern.warp_bending.assign(warp ? grid.size() : 0, 0.0);
  pattern.weft_bending.assign(weft ? grid.size() : 0, 0.0);
  for (int i = 0; i < grid.rows && (warp || weft); ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      const Fabric fabric = layers.fabricAt(i, j);
      if (fabric.bending_warp > 0.0)
        pattern.warp_bending[n] = stiffnessOf(neighbours.alongWarp(i, j), fabric.bending_warp);
      if (fabric.bending_weft > 0.0)
        pattern.weft_bending[n] = stiffnessOf(neighbours.alongWeft(i, j), fabric.bending_weft);
    }
  }
}

void fillTurningLengths(const ClothPattern& pattern, Field& warp, Field& weft) noexcept {
  const Grid& grid = pattern.grid;
  const Neighbours neighbours(pattern);
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      warp[n] = lengthOf(neighbours.alongWarp(i, j));
      weft[n] = lengthOf(neighbours.alongWeft(i, j));
    }
  }
}

}  // namespace curtain
