// SPDX-License-Identifier: BSD-3-Clause
#include "cloth/pin_moves.h"

#include <algorithm>

#include "scene/ranges.h"

namespace curtain {

bool isPlace(const Vec3& point) { return point.allFinite() && point.cwiseAbs().maxCoeff() <= kLargest; }

// Keeps the moves that stays(move) is true for, in their order.
template <typename Stays>
void PinMoves::keep(const Stays& stays) noexcept {
  std::size_t left = 0;
  arrived_ = 0;
  for (const Move& move : moves_) {
    if (!stays(move)) {
      slot_[move.node] = kNone;
      continue;
    }
    slot_[move.node] = left;
    arrived_ += move.arrived ? 1 : 0;
    moves_[left++] = move;
  }
  moves_.resize(left);
}

void PinMoves::move(std::size_t node, const Vec3& target, bool held) noexcept {
  if (slot_[node] == kNone) {
    slot_[node] = moves_.size();
    moves_.push_back({node, target, false, false, held});
    return;
  }
  Move& known = moves_[slot_[node]];
  known.target = target;
  known.held = held;
  arrived_ -= known.arrived ? 1 : 0;
  known.arrived = false;
}

void PinMoves::letGo(std::size_t node) noexcept {
  if (slot_[node] != kNone) keep([node](const Move& move) { return move.node != node; });
}

void PinMoves::clear() noexcept {
  keep([](const Move&) { return false; });
}

bool PinMoves::settle(ClothState& state) noexcept {
  if (arrived_ == 0) return false;
  keep([&](const Move& move) {
    if (move.arrived) state.velocity.set(move.node, Vec3::Zero());
    return !move.arrived;
  });
  return true;
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
  for (Move& move : moves_) {
    move.arrived = whole && !move.behind;
    move.behind = !move.arrived;
    if (move.arrived) state.position.set(move.node, move.target);
    if (!move.arrived || !move.held) state.velocity.set(move.node, Vec3::Zero());
  }
  keep([](const Move& move) { return !move.arrived || move.held; });
}

void PinMoves::resume() noexcept {
  std::fill(slot_.begin(), slot_.end(), kNone);
  keep([](const Move&) { return true; });
}

}  // namespace curtain
