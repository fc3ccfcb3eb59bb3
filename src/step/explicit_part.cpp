// SPDX-License-Identifier: BSD-3-Clause
#include "step/explicit_part.h"

#include <algorithm>

namespace curtain {

void ExplicitPart::assign(std::size_t size) {
  for (Field3* const field : {&sum_, &ahead_}) field->assign(size, 0.0);
}

void ExplicitPart::begin(const NodeInertia& inertia, const Field&, double scale, bool explicit_links) noexcept {
  share_ = inertia.elasticShare(scale, explicit_links);
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
