// SPDX-License-Identifier: BSD-3-Clause
#include "parts/pins/scene_pins.h"

namespace curtain {

ScenePins::ScenePins(const Scene& scene, const ClothPattern& pattern)
    : PinMoves(scene, pattern), motion_(Pose(), scene.pins_motion, 1.0) {}

void ScenePins::reset(ClothState& state) {
  PinMoves::reset(state);
  places_.clear();
  if (!motion_.any()) return;
  const Pose first = motion_.at(0.0);
  const Grid& grid = pattern_.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (std::size_t n = grid.index(i, 0); n < grid.index(i, grid.columns); ++n) {
      if (pattern_.scene_pins[n] == kPinned)
        places_.push_back({n, first.orientation.conjugate() * (state.position.at(n) - first.position)});
    }
  }
}

bool ScenePins::wakes(const FrameBegin& begin, const ClothState& state) const noexcept {
  return PinMoves::wakes(begin, state) || moves(begin);
}

bool ScenePins::prepareFrame(const FrameBegin& begin, ClothState& state) noexcept {
  if (moves(begin)) {
    const Pose to = motion_.at(begin.to);
    for (const Place& place : places_) move(place.node, to.position + to.orientation * place.local);
  }
  return PinMoves::prepareFrame(begin, state);
}

}  // namespace curtain
