// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/obstacle_lag.h"

#include <algorithm>
#include <limits>

namespace curtain {

ObstacleLag::ObstacleLag(const ClothPattern& pattern, const FrameTimes& times, ObstacleSet& obstacles,
                         ClothContact& contact)
    : times_(times), obstacles_(obstacles), contact_(contact), shortest_link_(shortestLink(pattern)) {}

void ObstacleLag::setSubstep(const SubstepPlan& plan, double done, const Field3& position) noexcept {
  const double frame_length = times_.length();
  from_ = (done - lag_) / frame_length;
  share_ = 1.0;
  obstacles_.setSubstep(from_, from_ + plan.h / frame_length);
  const double most = plan.isLastResort() ? plan.reach * shortest_link_ : std::numeric_limits<double>::infinity();
  contact_.limitRecovery(most);
  if (!plan.isLastResort()) return;
  double path = 0.0;
  for (int o = 0; o < obstacles_.count(); ++o) {
    if (contact_.standing(o, position) == ObstacleStanding::kNear) path = std::max(path, obstacles_.path(o));
  }
  path *= plan.h / frame_length;
  if (path <= most) return;
  share_ = most / path;
  obstacles_.setSubstep(from_, from_ + share_ * plan.h / frame_length);
}

double ObstacleLag::substepMade(double share, double h) noexcept {
  const double made = share * share_, waits = (1.0 - made) * h;
  if (share < 1.0) obstacles_.setSubstep(from_, from_ + made * h / times_.length());
  lag_ += waits;
  return obstacles_.anyMoved() ? waits : 0.0;
}

void ObstacleLag::endFrame(double share) noexcept {
  obstacles_.endFrame(share - lag_ / times_.length());
  lag_ = from_ = 0.0;
  share_ = 1.0;  // substeps without obstacles do not set them
}

}  // namespace curtain
