// SPDX-License-Identifier: BSD-3-Clause
//
// Nodes that a part guides, among the constraints: where the solve lets them be, and what acts on them.
#include "step/constants.h"
#include "step/constraints.h"

namespace curtain {

void Constraints::beginGuide(const SubstepStart& start, const ClothState& state) noexcept {
  guide_->begin(start, state, inertia_.inverse());
  other_force_ = &start.force;
  presses_ = 0;
}

Vec3 Constraints::ForceNow::at(int row, int column) const noexcept {
  const std::size_t n = of_.pattern_.grid.index(row, column);
  Vec3 pull = of_.pullAt(row, column, of_.warp_.multiplier, of_.weft_.multiplier, of_.directions_set_);
  if (of_.distances_.any()) pull += of_.distances_.presentPullAt(n);
  return of_.per_scale_ * pull + of_.other_force_->at(n);
}

// Friction follows what the links press with for as many sweeps as in contact; then it is fixed, so that sweeps end.
void Constraints::settleGuide() noexcept {
  if (guided() == nullptr) return;
  if (presses_ <= kFrictionSweeps) {
    ++presses_;
    guide_->press(ForceNow(*this));
  }
  if (guide_->settle(next)) net_ready_ = false;
}

// Returns the largest load of a guided node over its mass.
double Constraints::commitGuide(ClothState& state, const Field& load) noexcept {
  guide_->commit(state);
  double heaviest = 0.0;
  guide_->forEach(0, pattern_.grid.columns, [&](const GuidedNode& guided, int, int) {
    heaviest = std::max(heaviest, load[guided.node] * inertia_.masses()[guided.node]);
  });
  return heaviest;
}

}  // namespace curtain
