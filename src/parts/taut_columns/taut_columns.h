// SPDX-License-Identifier: BSD-3-Clause
//
// Columns that are straight between two pins. Rods keep their lengths, so a column whose pins are as far apart as it is
// long can't move: to sag it would have to be longer. Its rods' equations are singular, and no load on it has a finite
// tension. So its nodes are held, and move with the line between the two, as long as it is straight.
//
// The same holds below a carrier that comes no nearer to the pin wherever it goes on its rail: it is held, too, unless
// the pin moves.
#pragma once

#include <vector>

#include "step/part.h"

namespace curtain {

/// Not thread-safe. Allocates only in its constructor. The last part: it asks what the others pin.
class TautColumns final : public Part {
 public:
  /// scene and pattern must outlive this.
  TautColumns(const Scene& scene, const ClothPattern& pattern);

  void reset(ClothState& state) override;
  void serialize(Archive& archive) override;
  void resume() override;
  void pin(std::vector<std::uint8_t>& pinned) const noexcept override;
  bool beginFrame(const FrameBegin& begin, ClothState& state) noexcept override;
  bool endFrame(const FrameEnd& end, ClothState& state) noexcept override;

 private:
  /// The rods between two pins that follow each other in a column, with nodes in between. The first may be a carrier.
  struct Span {
    std::size_t first, last;  // its pins
    double length;            // [m]
  };

  bool isHeld(std::size_t node) const noexcept { return held_[node] != 0 && pattern_.pinned[node] == kHeld; }
  void findSpans(const std::vector<std::uint8_t>& pinned) const noexcept;
  bool hangsFromCarrier(const Span& span) const noexcept { return pattern_.scene_pins[span.first] == kGuided; }
  Vec3 freedomOf(const Span& span, const ClothState& state) const noexcept;
  bool isStraight(const Span& span, const ClothState& state, const Vec3& moved) const noexcept;
  template <typename Visit>
  void forEachHeld(const Span& span, const Visit& visit) const;
  bool rodsHold(const Span& span, const Field3& position) const noexcept;
  bool find(const ClothState& state) noexcept;
  void list() noexcept;

  const Scene& scene_;
  const ClothPattern& pattern_;
  std::vector<std::uint8_t> held_, before_;  // by node; before: scratch of find()
  std::vector<std::size_t> list_;            // of held nodes
  mutable std::vector<Span> spans_;          // between the pins that pin() was told
};

}  // namespace curtain
