// SPDX-License-Identifier: BSD-3-Clause
#include "parts/rail/opening.h"

#include "scene/ranges.h"

namespace curtain {

Opening::Opening(const Scene& scene, const ClothPattern& pattern, Carriers& carriers)
    : scene_(scene), pattern_(pattern), carriers_(carriers), drive_(scene.rail.drive) {}

void Opening::reset() {
  draws_ = false;
  goal_ = 0.0;
  drive_ = scene_.rail.drive;
  take();
}

void Opening::draw(double opening) {
  draws_ = true;
  goal_ = opening;
  take();
}

void Opening::letGo() {
  draws_ = false;
  take();
}

void Opening::setDrive(const DriveParams& drive) {
  drive_ = drive;
  take();
}

void Opening::take() {
  if (pattern_.rail.empty()) return;
  RailDrive drive{draws_, drive_.speed, drive_.force, {}};
  const std::vector<double> places = pattern_.rail.layout.placesFor(goal_);
  for (const std::size_t master : pattern_.rail.layout.masters()) drive.goal.push_back(places[master]);
  carriers_.setDrive(drive);
}

bool Opening::isUnderWay(const ClothState& state) const noexcept {
  if (!draws_ || pattern_.rail.empty()) return false;
  const std::vector<std::size_t>& masters = pattern_.rail.layout.masters();
  for (std::size_t m = 0; m < masters.size(); ++m) {
    if (state.place[masters[m]] != carriers_.drive().goal[m]) return true;
  }
  return false;
}

void Opening::measure(const ClothState& state, Statistics& statistics) const noexcept {
  if (!pattern_.rail.empty()) statistics.opening = pattern_.rail.layout.openingOf(state.place);
}

void Opening::carry(Archive& archive) {
  archive.flag("draws", draws_);
  archive.within("goal", goal_, 0.0, 1.0);
  archive.within("speed", drive_.speed, kSmallest, kLargest);
  archive.within("force", drive_.force, 0.0, kLargest);
}

}  // namespace curtain
