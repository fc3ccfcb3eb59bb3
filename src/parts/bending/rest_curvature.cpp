// SPDX-License-Identifier: BSD-3-Clause
#include "parts/bending/rest_curvature.h"

#include <algorithm>
#include <cmath>

namespace curtain {
namespace {

constexpr double kShortest = 0.1;  // of the two links across

}  // namespace

RestCurvature::RestCurvature(const ClothPattern& pattern, bool warp) : pattern_(pattern), warp_(warp) {
  const Field& turn = warp ? pattern.warp_rest_turn : pattern.weft_rest_turn;
  couples_.reserve(
      static_cast<std::size_t>(std::count_if(turn.begin(), turn.end(), [](double angle) { return angle != 0.0; })));
  fill();
}

void RestCurvature::fill() noexcept {
  const Field& turn = warp_ ? pattern_.warp_rest_turn : pattern_.weft_rest_turn;
  const Field& stiffness = warp_ ? pattern_.warp_bending : pattern_.weft_bending;
  const Field& rest = warp_ ? pattern_.warp_rest : pattern_.weft_rest;
  couples_.clear();
  constant_ = 0.0;
  if (turn.empty() || stiffness.empty()) return;
  const bool warp = warp_;
  const Grid& grid = pattern_.grid;
  // Neighbours along the warp and the weft; at a border, or a slit, the node itself.
  const auto up = [&](int i, int j) { return grid.index(std::max(i - 1, 0), j); };
  const auto down = [&](int i, int j) { return grid.index(std::min(i + 1, grid.rows - 1), j); };
  const int last = grid.columns - 1;
  const auto left = [&](int i, int j) { return grid.index(i, !grid.hasLink(i, j) ? j : j > 0 ? j - 1 : last); };
  const auto right = [&](int i, int j) {
    const int next = j < last ? j + 1 : 0;
    return grid.index(i, grid.hasLink(i, next) ? next : j);
  };
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      const double k = stiffness[n], angle = turn[n];
      if (k == 0.0 || angle == 0.0) continue;
      Couple couple;
      couple.node = n;
      couple.before = warp ? up(i, j) : left(i, j);
      couple.after = warp ? down(i, j) : right(i, j);
      couple.left = warp ? left(i, j) : up(i, j);
      couple.right = warp ? right(i, j) : down(i, j);
      couple.moment = k * std::sin(angle);
      couple.constant = k * (1.0 - std::cos(angle));
      couple.per_before = 1.0 / rest[n];
      couple.per_after = 1.0 / rest[couple.after];
      const Field& across = warp ? pattern_.weft_rest : pattern_.warp_rest;
      couple.shortest =
          kShortest * ((couple.left != n ? across[n] : 0.0) + (couple.right != n ? across[couple.right] : 0.0));
      constant_ += couple.constant;
      couples_.push_back(couple);
    }
  }
}

// The gradient of -M n . (t x t') by t is -M t' x n, by t' -M n x t, and by the vector d that n = d / |d| is of,
// -M (c - n (n . c)) / |d| with c = t x t'.
double RestCurvature::addTo(const Field3& position, Field3& force) const noexcept {
  double energy = 0.0;
  for (const Couple& couple : couples_) {
    energy += couple.constant;
    const Vec3 here = position.at(couple.node);
    const Vec3 t = couple.per_before * (here - position.at(couple.before));
    const Vec3 next = couple.per_after * (position.at(couple.after) - here);
    const Vec3 across = position.at(couple.right) - position.at(couple.left);
    const double length = across.norm();
    // Folded onto itself it has no direction: there the axis shortens with it, so that forces stay bounded.
    const bool folded = length < couple.shortest;
    const double reach = folded ? couple.shortest : length;
    const Vec3 axis = across / reach, turn = t.cross(next);
    energy -= couple.moment * axis.dot(turn);
    const Vec3 on_before = couple.moment * couple.per_before * next.cross(axis);
    const Vec3 on_after = couple.moment * couple.per_after * axis.cross(t);
    const Vec3 on_axis = couple.moment / reach * (folded ? turn : Vec3(turn - axis.dot(turn) * axis));
    force.add(couple.before, -on_before);
    force.add(couple.node, on_before - on_after);
    force.add(couple.after, on_after);
    force.add(couple.right, on_axis);
    force.add(couple.left, -on_axis);
  }
  return energy;
}

}  // namespace curtain
