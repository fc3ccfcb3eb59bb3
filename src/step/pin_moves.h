// SPDX-License-Identifier: BSD-3-Clause
//
// Moves of pinned nodes, evenly over a frame. One that did not arrive follows in the next frames, no faster than
// kCatchUp (obstacles/obstacle_set.h) allows.
#pragma once

#include <vector>

#include "step/part.h"

namespace curtain {

/// A point that something can be moved to [m].
bool isPlace(const Vec3& point);

/// The scene's pins and the fixed ends beside the cloth, which the user moves; or the pins of a part.
class PinMoves : public Part {
 public:
  /// scene and pattern must outlive this. may_be_freed: between two frames nodes that have arrived have the velocity
  /// that they moved with; else none.
  PinMoves(const Scene& scene, const ClothPattern& pattern, bool may_be_freed = false);

  /// node: pinned; target: position at the next frame's end [m]. Allocates nothing.
  void move(std::size_t node, const Vec3& target) noexcept;

  void reset(ClothState&) override { clear(); }
  void serialize(Archive& archive) override;
  void resume() override;
  bool wakes(const FrameBegin&, const ClothState&) const noexcept override { return moves(); }
  bool drives(const ClothState&) const noexcept override { return moves(); }
  bool strains() const noexcept override { return moves(); }
  /// Nodes that have arrived and are not moved on stop.
  bool prepareFrame(const FrameBegin& begin, ClothState& state) noexcept override;
  bool beginFrame(const FrameBegin& begin, ClothState& state) noexcept override;
  bool endFrame(const FrameEnd& end, ClothState& state) noexcept override;

 protected:
  /// The node is not pinned any more: it keeps its velocity.
  void letGo(std::size_t node) noexcept;
  void clear() noexcept;
  /// While serialize() loads: the node will be one of its pins.
  virtual bool willPin(std::size_t node) const noexcept { return pattern_.scene_pins[node] == kPinned; }

  const Scene& scene_;
  const ClothPattern& pattern_;

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};
  struct Move {
    std::size_t node = 0;
    Vec3 target = Vec3::Zero();
    double pace = 0.0;     // of its target, at its fastest since it was last there [m a frame]
    bool behind = false;   // did not arrive in the last frame
    bool arrived = false;  // in the last frame; only its velocity is left
  };
  bool moves() const noexcept;
  template <typename Stays>
  void keep(const Stays& stays) noexcept;

  const bool may_be_freed_;
  std::vector<Move> moves_;        // at most one a node
  std::vector<std::size_t> slot_;  // by node: its place in moves_, or kNone
};

}  // namespace curtain
