// SPDX-License-Identifier: BSD-3-Clause
//
// Moves of pinned nodes, evenly over a frame. One that did not arrive follows in the next frames, no faster than
// followingSpeed() (contact/shapes/obstacle_set.h).
#pragma once

#include <vector>

#include "cloth/cloth.h"

namespace curtain {

/// A point that something can be moved to [m].
bool isPlace(const Vec3& point);

/// Not thread-safe.
class PinMoves {
 public:
  /// node: pinned; target: position at the next frame's end [m]. Allocates.
  void move(std::size_t node, const Vec3& target);
  bool any() const noexcept { return !moves_.empty(); }
  void clear() noexcept { moves_.clear(); }

  /// Before a frame: sets the nodes' velocities. frame_rate [1/s]; following_speed: limit for those that are behind
  /// [m/s].
  void start(double frame_rate, double following_speed, ClothState& state) noexcept;
  /// After a frame. whole: all of it was made, and no pin had to wait.
  void stop(bool whole, ClothState& state) noexcept;

  void carry(Archive& archive, const ClothPattern& of);

 private:
  struct Move {
    std::size_t node;
    Vec3 target;
    bool behind;  // did not arrive in the last frame
  };
  std::vector<Move> moves_;
};

}  // namespace curtain
