// SPDX-License-Identifier: BSD-3-Clause
//
// Carriers among the constraints: where the solve lets them be, and what presses them on the rail.
#include "solver/constants.h"
#include "solver/constraints.h"

namespace curtain {

void Constraints::beginCarriers(const SubstepStart& start, const ClothState& state, double h) noexcept {
  const double scale = start.h * start.kick;
  carriers_.begin(state, start.state, inertia_.inverse(), h, start.h, scale);
  per_scale_ = 1.0 / scale;
  presses_ = 0;
  for (const Carrier& carrier : carriers_.all())
    top_force_.set(carriers_.node(carrier), start.force.at(carriers_.node(carrier)));
}

// Friction follows what the links press with for as many sweeps as in contact; then it is fixed, so that sweeps end.
void Constraints::settleCarriers() noexcept {
  if (!carriers_.slide()) return;
  if (presses_ <= kFrictionSweeps) {
    ++presses_;
    carriers_.press([&](int column) -> Vec3 {
      const auto n = static_cast<std::size_t>(column);
      const Vec3 pull = pullAt(0, column, warp_.multiplier, weft_.multiplier, directions_set_);
      return per_scale_ * (distances_.any() ? Vec3(pull + distances_.presentPullAt(n)) : pull) + top_force_.at(n);
    });
  }
  if (carriers_.settle(next)) net_ready_ = false;
}

// Returns the largest load of a carrier over its mass.
double Constraints::commitCarriers(ClothState& state, const Field& load) noexcept {
  carriers_.commit(state);
  double heaviest = 0.0;
  for (const Carrier& carrier : carriers_.all()) {
    const std::size_t n = carriers_.node(carrier);
    heaviest = std::max(heaviest, load[n] * inertia_.masses()[n]);
  }
  return heaviest;
}

}  // namespace curtain
