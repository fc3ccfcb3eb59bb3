// SPDX-License-Identifier: BSD-3-Clause
#include "step/explicit_part.h"

#include <algorithm>
#include <cmath>

#include "step/constants.h"

namespace curtain {

void ExplicitPart::assign(std::size_t size) {
  for (Field3* const field : {&sum_, &ahead_}) field->assign(size, 0.0);
}

void ExplicitPart::begin(const NodeInertia& inertia, const Field&, double scale, bool explicit_links) noexcept {
  if (!(inertia.elastic() > 0.0)) return;
  const NodeInertia::Tensions& tensions = inertia.tensions();
  const double size = std::abs(scale);
  const double taken =
      explicit_links && tensions.scale != 0.0 ? 2.0 * size / std::abs(tensions.scale) * tensions.heaviest : 0.0;
  const double left =
      explicit_links ? std::max(kLeastForElastic, kStablePhase * kStablePhase - taken) : kElasticBackward;
  share_ = std::min(1.0, left / (size * inertia.elastic()));
}

const Field3& ExplicitPart::addTo(const Field3& force, const Field3& position) noexcept {
  sum_ = force;
  addOwn(position, sum_);
  return sum_;
}

const Field3& ExplicitPart::addAhead(const SubstepStart& start, const Field& inverse) noexcept {
  setAhead(start, inverse, ahead_);
  return addTo(start.force, ahead_);
}

const Field3& ExplicitPart::forceAt(const Field3& position, double& energy) noexcept {
  for (Field* const axis : {&sum_.x, &sum_.y, &sum_.z}) std::fill(axis->begin(), axis->end(), 0.0);
  addOwn(position, sum_);
  energy = energyAt(position);
  return sum_;
}

double ExplicitPart::energyAfter(const Field3&, const Field3& position) const noexcept { return energyAt(position); }

}  // namespace curtain
