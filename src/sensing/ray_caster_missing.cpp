// SPDX-License-Identifier: BSD-3-Clause
//
// In place of ray_caster.cpp in a build without Embree.
#include <stdexcept>

#include "sensing/ray_caster.h"

namespace curtain {

struct RayCaster::Impl {};

bool RayCaster::available() { return false; }

RayCaster::RayCaster(const Simulator&, std::optional<double>) {
  throw std::runtime_error("this build is without Embree, it casts no rays");
}
RayCaster::~RayCaster() = default;

void RayCaster::place(const Moment&, const Pose&) {}
void RayCaster::cast(const RayGrid&, const RayRange&, std::uint64_t, std::vector<RayHit>&) const {}

}  // namespace curtain
