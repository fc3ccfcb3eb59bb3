// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/pin_moves.h"

#include <algorithm>

#include "scene/ranges.h"

namespace curtain {

bool isPlace(const Vec3& point) { return point.allFinite() && point.cwiseAbs().maxCoeff() <= kLargest; }

void PinMoves::move(std::size_t node, const Vec3& target) {
  const auto found = std::find_if(moves_.begin(), moves_.end(), [node](const Move& move) { return move.node == node; });
  if (found != moves_.end())
    found->target = target;
  else
    moves_.push_back({node, target, false});
}

// Pinned nodes move by their velocity alone.
void PinMoves::start(double frame_rate, double following_speed, ClothState& state) noexcept {
  for (Move& move : moves_) {
    const Vec3 velocity = (move.target - state.position.at(move.node)) * frame_rate;
    const double share = move.behind ? std::min(1.0, following_speed / velocity.norm()) : 1.0;
    state.velocity.set(move.node, share * velocity);
    move.behind = share < 1.0;
  }
}

void PinMoves::stop(bool whole, ClothState& state) noexcept {
  std::size_t left = 0;
  for (Move& move : moves_) {
    state.velocity.set(move.node, Vec3::Zero());
    if (whole && !move.behind) {
      state.position.set(move.node, move.target);
    } else {
      move.behind = true;
      moves_[left++] = move;
    }
  }
  moves_.resize(left);
}

}  // namespace curtain
