// SPDX-License-Identifier: BSD-3-Clause
#include "step/pin_moves.h"

#include <algorithm>
#include <limits>

#include "cloth/archive.h"
#include "obstacles/obstacle_set.h"
#include "scene/ranges.h"

namespace curtain {

bool isPlace(const Vec3& point) { return point.allFinite() && point.cwiseAbs().maxCoeff() <= kLargest; }

PinMoves::PinMoves(const Scene& scene, const ClothPattern& pattern, bool may_be_freed)
    : scene_(scene), pattern_(pattern), may_be_freed_(may_be_freed), slot_(pattern.grid.size(), kNone) {
  moves_.reserve(pattern.grid.size());
}

// Keeps the moves that stays(move) is true for, in their order.
template <typename Stays>
void PinMoves::keep(const Stays& stays) noexcept {
  std::size_t left = 0;
  for (const Move& move : moves_) {
    if (!stays(move)) {
      slot_[move.node] = kNone;
      continue;
    }
    slot_[move.node] = left;
    moves_[left++] = move;
  }
  moves_.resize(left);
}

bool PinMoves::moves() const noexcept {
  return !moves_.empty() && std::any_of(moves_.begin(), moves_.end(), [](const Move& move) { return !move.arrived; });
}

void PinMoves::move(std::size_t node, const Vec3& target) noexcept {
  if (slot_[node] == kNone) {
    slot_[node] = moves_.size();
    moves_.push_back({node, target});
    return;
  }
  Move& move = moves_[slot_[node]];
  move.pace = std::max(move.pace, (target - move.target).norm());
  move.target = target;
  move.arrived = false;
}

void PinMoves::letGo(std::size_t node) noexcept {
  if (slot_[node] != kNone) keep([node](const Move& move) { return move.node != node; });
}

void PinMoves::clear() noexcept {
  keep([](const Move&) { return false; });
}

bool PinMoves::prepareFrame(const FrameBegin&, ClothState& state) noexcept {
  bool stops = false;
  keep([&](const Move& move) {
    if (move.arrived) state.velocity.set(move.node, Vec3::Zero());
    stops = stops || move.arrived;
    return !move.arrived;
  });
  return stops;
}

// Pinned nodes move by their velocity alone.
bool PinMoves::beginFrame(const FrameBegin& begin, ClothState& state) noexcept {
  for (Move& move : moves_) {
    const Vec3 path = move.target - state.position.at(move.node);
    if (!move.behind) move.pace = path.norm();
    const double allowed = kCatchUp * move.pace;
    const double share = path.norm() > allowed ? allowed / path.norm() : 1.0;
    state.velocity.set(move.node, share * begin.rate * path);
    move.behind = share < 1.0;
  }
  return false;
}

bool PinMoves::endFrame(const FrameEnd& end, ClothState& state) noexcept {
  for (Move& move : moves_) {
    move.arrived = end.arrived && !move.behind;
    move.behind = !move.arrived;
    if (move.arrived) state.position.set(move.node, move.target);
    if (!move.arrived || !may_be_freed_) state.velocity.set(move.node, Vec3::Zero());
  }
  keep([this](const Move& move) { return !move.arrived || may_be_freed_; });
  return false;
}

// Ends of lines are no nodes of the cloth, but pins that move as they do.
void PinMoves::serialize(Archive& archive) {
  std::vector<std::uint8_t> seen(archive.loads() ? slot_.size() : 0, 0);
  archive.list("pin_moves", moves_, [&](Move& move) {
    archive.node("node", move.node, pattern_.grid);
    if (archive.loads()) {
      archive.require(willPin(move.node), "must be a pinned node");
      archive.require(seen[move.node] == 0, "must name a node once");
      seen[move.node] = 1;
    }
    archive.finite("target", move.target);
    archive.within("pace", move.pace, 0.0, std::numeric_limits<double>::infinity());
    archive.flag("behind", move.behind);
    archive.flag("arrived", move.arrived);
  });
}

void PinMoves::resume() {
  std::fill(slot_.begin(), slot_.end(), kNone);
  keep([](const Move&) { return true; });
}

}  // namespace curtain
