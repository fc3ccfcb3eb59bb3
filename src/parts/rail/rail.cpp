// SPDX-License-Identifier: BSD-3-Clause
#include "parts/rail/rail.h"

#include <algorithm>

#include "cloth/archive.h"
#include "scene/ranges.h"

namespace curtain {

std::optional<std::size_t> Rail::railOf(std::size_t layer) const noexcept {
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    if (tracks_[t].rail.layer == layer) return t;
  }
  return std::nullopt;
}

const DriveParams& Rail::driveOf(const Track& track) const noexcept {
  const std::size_t layer = track.rail.layer;
  return layer == 0 ? scene_.rail.drive : scene_.layers[layer - 1].rail.drive;
}

void Rail::reset(ClothState&) {
  for (Track& track : tracks_) {
    track.asked = {false, 0.0, driveOf(track)};
    track.force = 0.0;
  }
  resume();
}

void Rail::ask(std::size_t rail, const Asked& asked) {
  tracks_[rail].asked = asked;
  resume();
}

void Rail::resume() {
  for (Track& track : tracks_) {
    const std::vector<double> places = track.rail.layout.placesFor(track.asked.opening);
    const std::vector<std::size_t>& masters = track.rail.layout.masters();
    for (std::size_t m = 0; m < masters.size(); ++m) track.goal[m] = places[masters[m]];
  }
}

// Carriers to the nearest places that the gaps between them leave.
void Rail::placed(const ClothState&, ClothState& state) noexcept {
  for (const Track& track : tracks_) {
    const RailPattern& rail = track.rail;
    for (std::size_t k = track.first; k < track.end; ++k) {
      const std::size_t n = node(all_[k]);
      const double most = rail.path.length() - rail.gap * static_cast<double>(track.end - 1 - k);
      const double after = k > track.first ? state.place[k - 1] + rail.gap : 0.0;
      state.place[k] = std::min(most, std::max(after, rail.path.nearest(state.position.at(n))));
      const RailPath::Place at = rail.path.at(state.place[k]);
      state.position.set(n, at.point);
      state.velocity.set(n, state.velocity.at(n).dot(at.tangent) * at.tangent);
    }
  }
}

bool Rail::hasArrived(const Track& track, const ClothState& state) const noexcept {
  const std::vector<std::size_t>& masters = track.rail.layout.masters();
  for (std::size_t m = 0; m < masters.size(); ++m) {
    if (state.place[track.first + masters[m]] != track.goal[m]) return false;
  }
  return true;
}

bool Rail::isUnderWay(const ClothState& state) const noexcept {
  return std::any_of(tracks_.begin(), tracks_.end(),
                     [&](const Track& track) { return track.asked.draws && !hasArrived(track, state); });
}

bool Rail::drives(const ClothState&) const noexcept {
  return std::any_of(tracks_.begin(), tracks_.end(), [](const Track& track) { return track.asked.draws; });
}

double Rail::openingOf(std::size_t rail, const ClothState& state) const noexcept {
  return tracks_[rail].rail.layout.openingOf(state.place.data() + tracks_[rail].first);
}

void Rail::measure(const ClothState& state, Statistics& statistics) const noexcept {
  if (const std::optional<std::size_t> rail = railOf(0)) statistics.opening = openingOf(*rail, state);
}

bool Rail::endFrame(const FrameEnd& end, ClothState&) noexcept {
  for (Track& track : tracks_) track.force = track.impulse / end.length;
  if (const std::optional<std::size_t> rail = railOf(0)) end.statistics.drive_force = driveForce(*rail);
  return false;
}

bool Rail::explain(const ClothState& state, double, Plan& plan) const {
  plan.push_back({"rail", any(),
                  !any() ? "there is none"
                         : std::to_string(all_.size()) + " carriers slide" +
                               (drives(state) ? ", and the drive draws them" : "; the drive has let go")});
  return false;
}

void Rail::serialize(Archive& archive) {
  for (Carrier& carrier : all_) {
    archive.flag("stays", carrier.stays);
    archive.flag("joins", carrier.joins);
    archive.finite("force", carrier.force);
    archive.finite("drawn", carrier.drawn);
  }
  for (Track& track : tracks_) {
    archive.finite("drive_force", track.force);
    archive.flag("draws", track.asked.draws);
    archive.within("opening", track.asked.opening, 0.0, 1.0);
    archive.within("speed", track.asked.drive.speed, kSmallest, kLargest);
    archive.within("force", track.asked.drive.force, 0.0, kLargest);
  }
}

}  // namespace curtain
