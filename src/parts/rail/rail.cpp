// SPDX-License-Identifier: BSD-3-Clause
#include "parts/rail/rail.h"

#include <algorithm>

#include "cloth/archive.h"
#include "scene/ranges.h"

namespace curtain {

void Rail::reset(ClothState&) { ask({false, 0.0, scene_.rail.drive}); }

void Rail::ask(const Asked& asked) {
  asked_ = asked;
  resume();
}

void Rail::resume() {
  if (!any()) return;
  const std::vector<double> places = pattern_.rail.layout.placesFor(asked_.opening);
  const std::vector<std::size_t>& masters = pattern_.rail.layout.masters();
  for (std::size_t m = 0; m < masters.size(); ++m) goal_[m] = places[masters[m]];
}

// Carriers to the nearest places that the gaps between them leave.
void Rail::placed(const ClothState&, ClothState& state) noexcept {
  const RailPattern& rail = pattern_.rail;
  double least = 0.0;
  for (std::size_t k = 0; k < rail.size(); ++k, least += rail.gap) {
    const auto n = static_cast<std::size_t>(rail.columns[k]);
    const double most = rail.path.length() - rail.gap * static_cast<double>(rail.size() - 1 - k);
    const double after = k > 0 ? state.place[k - 1] + rail.gap : 0.0;
    state.place[k] = std::min(most, std::max(after, rail.path.nearest(state.position.at(n))));
    const RailPath::Place at = rail.path.at(state.place[k]);
    state.position.set(n, at.point);
    state.velocity.set(n, state.velocity.at(n).dot(at.tangent) * at.tangent);
  }
}

bool Rail::isUnderWay(const ClothState& state) const noexcept {
  if (!asked_.draws || !any()) return false;
  const std::vector<std::size_t>& masters = pattern_.rail.layout.masters();
  for (std::size_t m = 0; m < masters.size(); ++m) {
    if (state.place[masters[m]] != goal_[m]) return true;
  }
  return false;
}

void Rail::measure(const ClothState& state, Statistics& statistics) const noexcept {
  if (any()) statistics.opening = pattern_.rail.layout.openingOf(state.place);
}

bool Rail::endFrame(const FrameEnd& end, ClothState&) noexcept {
  end.statistics.drive_force = impulse_ / end.length;
  return false;
}

bool Rail::explain(const ClothState&, double, Plan& plan) const {
  plan.push_back({"rail", any(),
                  !any() ? "there is none"
                         : std::to_string(all_.size()) + " carriers slide" +
                               (asked_.draws ? ", and the drive draws them" : "; the drive has let go")});
  return false;
}

void Rail::serialize(Archive& archive) {
  for (Carrier& carrier : all_) {
    archive.flag("stays", carrier.stays);
    archive.flag("joins", carrier.joins);
    archive.finite("force", carrier.force);
    archive.finite("drawn", carrier.drawn);
  }
  archive.flag("draws", asked_.draws);
  archive.within("opening", asked_.opening, 0.0, 1.0);
  archive.within("speed", asked_.drive.speed, kSmallest, kLargest);
  archive.within("force", asked_.drive.force, 0.0, kLargest);
}

}  // namespace curtain
