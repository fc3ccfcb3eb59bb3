// SPDX-License-Identifier: BSD-3-Clause
//
// Moves of pinned nodes, evenly over a frame. One that did not arrive follows in the next frames, no faster than
// followingSpeed() (obstacles/obstacle_set.h). Between two frames a node that is held has the velocity that it
// moved with, the others none.
#pragma once

#include <functional>
#include <vector>

#include "cloth/cloth.h"

namespace curtain {

/// A point that something can be moved to [m].
bool isPlace(const Vec3& point);

/// Not thread-safe.
class PinMoves {
 public:
  explicit PinMoves(const ClothPattern& pattern) : slot_(pattern.grid.size(), kNone) {
    moves_.reserve(pattern.grid.size());
  }

  /// node: pinned; target: position at the next frame's end [m]; held: by a hand, which may let go of it. Allocates
  /// nothing.
  void move(std::size_t node, const Vec3& target, bool held = false) noexcept;
  /// The node is not pinned any more: it keeps its velocity.
  void letGo(std::size_t node) noexcept;
  /// One is under way, or shall be.
  bool any() const noexcept { return arrived_ < moves_.size(); }
  void clear() noexcept;

  /// Before a frame: nodes that have arrived and are not moved on stop. False: there were none.
  bool settle(ClothState& state) noexcept;
  /// After settle(): sets the nodes' velocities. frame_rate [1/s]; following_speed: limit for those that are behind
  /// [m/s].
  void start(double frame_rate, double following_speed, ClothState& state) noexcept;
  /// After a frame. whole: all of it was made, and no pin had to wait.
  void stop(bool whole, ClothState& state) noexcept;

  /// pinned: ClothPattern::pinned as it will be after loading.
  void carry(Archive& archive, const Grid& grid, const std::function<bool(std::size_t)>& is_pinned);
  /// After carry() has loaded.
  void resume() noexcept;

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};
  struct Move {
    std::size_t node = 0;
    Vec3 target = Vec3::Zero();
    bool behind = false;   // did not arrive in the last frame
    bool arrived = false;  // in the last frame; only its velocity is left
    bool held = false;     // by a hand
  };
  template <typename Stays>
  void keep(const Stays& stays) noexcept;

  std::vector<Move> moves_;        // at most one a node
  std::vector<std::size_t> slot_;  // by node: its place in moves_, or kNone
  std::size_t arrived_ = 0;        // how many of them have
};

}  // namespace curtain
