// SPDX-License-Identifier: BSD-3-Clause
//
// The drags that pull at a cloth, by id.
#pragma once

#include "parts/drag/drag_force.h"
#include "scene/sources.h"
#include "step/part.h"

namespace curtain {

/// Begins with the scene's. Allocates nothing in substeps.
class Drags final : public Part {
 public:
  /// All arguments must outlive this.
  Drags(const Scene& scene, const ClothPattern& pattern);

  /// A valid one. One that replaces another keeps its node, wherever that has moved since.
  void set(const DragParams& drag);
  bool remove(const std::string& id) { return drags_.remove(id); }
  void clear() { drags_ = {}; }
  const std::vector<DragParams>& params() const noexcept { return drags_.params; }

  void reset(ClothState& state) override;
  void serialize(Archive& archive) override;
  bool explain(const ClothState& state, double time, Plan& plan) const override;
  bool wakes(const FrameBegin& begin, const ClothState& state) const noexcept override;
  void announce(const ClothState& state, ForceSum& sum) noexcept override;
  void addForces(const ClothState& state, ForceSum& sum) noexcept override;

 private:
  const Scene& scene_;
  const ClothPattern& pattern_;
  Sources<DragForce, DragParams> drags_;
};

}  // namespace curtain
