// SPDX-License-Identifier: BSD-3-Clause
#include "parts/hands/hold_springs.h"

#include <algorithm>
#include <cmath>

namespace curtain {

// What sticks for certain: the last pull, and carrying all of the cloth along, are less than the limit. Else the
// velocities after the substep, which are not known yet, are taken to change as they did in the last one, so that cloth
// that slides ever faster feels the limit and no more.
double HoldSprings::shareOf(const std::vector<HeldNode>& held, const ClothState& state,
                            const FramePart& part) const noexcept {
  if (std::isinf(max_force_)) return 1.0;
  Vec3 sum = Vec3::Zero();
  double fastest = 0.0;
  for (const HeldNode& node : held) {
    const Vec3 at = state.position.at(node.node), before = state.velocity.at(node.node);
    const Vec3 velocity = 2.0 * before - node.velocity;
    sum += forceOf(node, at + part.h * velocity, velocity, part);
    fastest = std::max(fastest, (targetOf(node, part.end) - at - part.h * before).squaredNorm());
  }
  if (pull_ + mass_ * std::sqrt(fastest) / (part.h * part.h) <= max_force_) return 1.0;
  // And where they have pulled with more than the limit, the rest of it sets the cloth in motion.
  const double sets_in = part.h * std::max(0.0, pull_ - max_force_) / mass_;  // [m/s]
  const double wanted = sum.norm() + static_cast<double>(held.size()) * (stiffness_ * part.h + damping_) * sets_in;
  return wanted > max_force_ ? max_force_ / wanted : 1.0;
}

void HoldSprings::addForces(std::vector<HeldNode>& held, const ClothState& state, const FramePart& part, Field3& force,
                            Field& damping) noexcept {
  share_ = shareOf(held, state, part);
  for (HeldNode& node : held) {
    node.started = state.velocity.at(node.node);
    force.add(node.node, share_ * forceOf(node, state.position.at(node.node), Vec3::Zero(), part));
    damping[node.node] += share_ * (stiffness_ * part.h + damping_);
  }
}

void HoldSprings::substepAccepted(std::vector<HeldNode>& held, double pull) noexcept {
  pull_ = pull;
  for (HeldNode& node : held) node.velocity = node.started;
}

double HoldSprings::kept(const std::vector<HeldNode>& held, const Field3& position,
                         const FramePart& part) const noexcept {
  Vec3 sum = Vec3::Zero();
  for (const HeldNode& node : held) sum += stiffness_ * (targetOf(node, part.end) - position.at(node.node));
  const double pulls = sum.norm();
  return pulls > max_force_ ? max_force_ / pulls : 1.0;
}

}  // namespace curtain
