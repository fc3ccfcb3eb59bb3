// SPDX-License-Identifier: BSD-3-Clause
//
// Pinned nodes on their way to where they are told to be. They go evenly over a frame. One that has not got there
// follows in the next frames, no faster than followingSpeed() of the obstacles (contact/shapes/obstacle_set.h).
#pragma once

#include <vector>

#include "cloth/cloth.h"

namespace curtain {

/// Not thread-safe.
class PinMoves {
 public:
  /// node: pinned; target: where it is at the next frame's end [m]. Allocates.
  void move(std::size_t node, const Vec3& target);
  bool any() const noexcept { return !moves_.empty(); }
  void clear() noexcept { moves_.clear(); }

  /// Before a frame: gives the nodes their velocities. frame_rate [1/s]; following_speed: of those that are behind, at
  /// most [m/s].
  void start(double frame_rate, double following_speed, ClothState& state) noexcept;
  /// After it. whole: all of the frame was made, and no pin had to wait.
  void stop(bool whole, ClothState& state) noexcept;

  void carry(Archive& archive, const ClothPattern& of);

 private:
  struct Move {
    std::size_t node;
    Vec3 target;
    bool behind;  // it did not get there in the last frame
  };
  std::vector<Move> moves_;
};

}  // namespace curtain
