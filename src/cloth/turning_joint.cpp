// SPDX-License-Identifier: BSD-3-Clause
#include "cloth/turning_joint.h"

#include <algorithm>

namespace curtain {
namespace {

constexpr double kShortest = 0.1;  // of the two links across

}  // namespace

TurningJoint turningJoint(const ClothPattern& pattern, bool warp, int row, int column) noexcept {
  const Grid& grid = pattern.grid;
  const int last = grid.columns - 1, next = column < last ? column + 1 : 0;
  const std::size_t n = grid.index(row, column);
  const std::size_t up = grid.index(std::max(row - 1, 0), column),
                    down = grid.index(std::min(row + 1, grid.rows - 1), column),
                    left = !grid.hasLink(row, column) ? n : grid.index(row, column > 0 ? column - 1 : last),
                    right = grid.hasLink(row, next) ? grid.index(row, next) : n;
  TurningJoint joint;
  joint.node = n;
  joint.before = warp ? up : left;
  joint.after = warp ? down : right;
  joint.left = warp ? left : up;
  joint.right = warp ? right : down;
  const Field& along = warp ? pattern.warp_rest : pattern.weft_rest;
  const Field& across = warp ? pattern.weft_rest : pattern.warp_rest;
  joint.per_before = 1.0 / along[n];
  joint.per_after = 1.0 / along[joint.after];
  joint.shortest = kShortest * ((joint.left != n ? across[n] : 0.0) + (joint.right != n ? across[joint.right] : 0.0));
  return joint;
}

}  // namespace curtain
