// SPDX-License-Identifier: BSD-3-Clause
//
// The scene's pins and the fixed ends beside the cloth, which the user moves; the scene may move its pins itself, all
// as one body (pins_motion).
#pragma once

#include "obstacles/pose_curve.h"
#include "step/pin_moves.h"

namespace curtain {

/// Not thread-safe. Allocates in the constructor and serialize().
class ScenePins final : public PinMoves {
 public:
  /// scene and pattern must outlive this.
  ScenePins(const Scene& scene, const ClothPattern& pattern);

  void reset(ClothState& state) override;
  bool wakes(const FrameBegin& begin, const ClothState& state) const noexcept override;
  bool strains() const noexcept override { return !places_.empty() || PinMoves::strains(); }
  bool prepareFrame(const FrameBegin& begin, ClothState& state) noexcept override;

 private:
  struct Place {
    std::size_t node;
    Vec3 local;  // in the frame that the pins move with [m]
  };

  bool moves(const FrameBegin& begin) const noexcept {
    return !places_.empty() && motion_.fastest(begin.from, begin.to, 1.0) > 0.0;
  }

  ScriptedMotion motion_;
  std::vector<Place> places_;  // of the pins; empty: the scene moves them not
};

}  // namespace curtain
