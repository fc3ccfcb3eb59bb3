// SPDX-License-Identifier: BSD-3-Clause
//
// Hands in a frame: they move, are pulled at, and lose what they hold.
#include <algorithm>

#include "parts/hands/grasps.h"
#include "scene/ranges.h"

namespace curtain {
namespace {

// Links that are pulled apart may pull with anything.
Vec3 withinNumbers(const Vec3& pull) noexcept {
  if (!pull.allFinite()) return Vec3::Zero();
  const double size = pull.stableNorm();
  return size > kLargest ? Vec3(kLargest / size * pull) : pull;
}

}  // namespace

bool Grasps::wakes(const FrameBegin& begin, const ClothState& state) const noexcept {
  const auto moves = [&](const Grasp& grasp) {
    const bool scripted =
        grasp.hand != nullptr && grasp.holds() && grasp.motion.fastest(begin.from, begin.to, 1.0) > 0.0;
    return grasp.moves() || scripted;
  };
  return begins(begin) || (any() && (PinMoves::wakes(begin, state) || std::any_of(list_.begin(), list_.end(), moves)));
}

// Its time to take hold, or to let go, has come as the frame begins.
bool Grasps::isDue(const Grasp& grasp, double time) const noexcept {
  if (grasp.hand == nullptr) return false;
  if (grasp.end == GraspEnd::kWaiting) return grasp.hand->start <= time + kTimeRounding;
  return grasp.holds() && isOver(grasp, time);
}

bool Grasps::begins(const FrameBegin& begin) const noexcept {
  return std::any_of(list_.begin(), list_.end(), [&](const Grasp& grasp) { return isDue(grasp, begin.from); });
}

// Those that let go are first: what they held another may take.
void Grasps::begun(const FrameBegin& begin, ClothState& state) noexcept {
  for (Grasp& grasp : list_) {
    if (!grasp.holds() || !isDue(grasp, begin.from)) continue;
    release(grasp);
    grasp.end = GraspEnd::kReleased;
    note();
  }
  for (Grasp& grasp : list_) {
    if (grasp.end != GraspEnd::kWaiting || !isDue(grasp, begin.from)) continue;
    grasp.end = GraspEnd::kReleased;
    if (isOver(grasp, begin.from)) continue;  // between two frames
    grasp.params.frame = grasp.motion.at(begin.from);
    nodes_.clear();
    listFree(grasp.params, state.position, nodes_);
    grasp.end = GraspEnd::kMissed;
    if (nodes_.empty()) continue;
    hold(grasp, nodes_, state);
    note();
  }
}

bool Grasps::prepareFrame(const FrameBegin& begin, ClothState& state) noexcept {
  for (Grasp& grasp : list_) {
    if (grasp.hand != nullptr && grasp.holds()) grasp.to = grasp.motion.at(begin.to);
  }
  for (const Grasp& grasp : list_) {
    if (!grasp.pins || !grasp.moves()) continue;
    for (const HeldNode& held : grasp.held) move(held.node, toWorld(grasp.to, held.place));
  }
  return PinMoves::prepareFrame(begin, state);
}

// The nodes that a hand pins change their velocity here; what that takes, the hand has to give.
bool Grasps::beginFrame(const FrameBegin& begin, ClothState& state) noexcept {
  PinMoves::beginFrame(begin, state);
  if (!any()) return false;
  part_.frame_rate = begin.rate;
  for (Grasp& grasp : list_) {
    grasp.impulse = grasp.angular = Vec3::Zero();
    grasp.counted = 0.0;
    grasp.slid = false;
    for (HeldNode& held : grasp.held) {
      held.begin = toWorld(grasp.from, held.place);
      held.end = toWorld(grasp.to, held.place);
      if (!grasp.pins) continue;
      const Vec3 velocity = state.velocity.at(held.node);
      grasp.push(state.position.at(held.node), grasp.from.position,
                 pattern_.mass[held.node] * (held.velocity - velocity));
      held.velocity = velocity;
    }
  }
  return false;
}

void Grasps::announce(const ClothState&, ForceSum& sum) noexcept {
  part_.h = sum.h;
  part_.end = (sum.done + sum.h) * part_.frame_rate;
  for (const Grasp& grasp : list_) {
    if (!grasp.hasSprings()) continue;
    sum.acts = sum.damps = true;
    for (const HeldNode& held : grasp.held) sum.led.push_back(held.node);
  }
}

void Grasps::addForces(const ClothState& state, ForceSum& sum) noexcept {
  for (Grasp& grasp : list_) {
    if (grasp.hasSprings()) grasp.springs.addForces(grasp.held, state, part_, sum.force, sum.damping);
  }
}

void Grasps::substepDone(const SubstepMade& made) noexcept {
  if (!any()) return;
  for (Grasp& grasp : list_) {
    if (!grasp.holds()) continue;
    grasp.counted += made.h;
    if (!grasp.pins)
      countSprings(grasp, made.state);
    else if (made.links != nullptr)
      countPinned(grasp, made);
  }
  if (made.links != nullptr && made.contacts != nullptr) countContacts(made);
}

// All that acts on a pinned node acts on the hand.
void Grasps::countPinned(Grasp& grasp, const SubstepMade& made) noexcept {
  const auto stride = static_cast<std::size_t>(pattern_.grid.stride);
  const NodeForces& forces = made.forces;
  const Field3* const elastic = made.links->forcesWithElastic();
  const Field3& others = elastic != nullptr ? *elastic : *forces.force;
  const Vec3 origin = grasp.origin(part_.end);
  for (const HeldNode& held : grasp.held) {
    const std::size_t n = held.node;
    Vec3 sum = others.at(n);
    if (made.scale != 0.0)
      sum += made.links->pullAt(static_cast<int>(n / stride), static_cast<int>(n % stride)) / made.scale;
    if (forces.has_damping) sum -= forces.damping[n] * made.state.velocity.at(n);
    grasp.push(made.state.position.at(n), origin, made.h * sum);
  }
}

void Grasps::countContacts(const SubstepMade& made) noexcept {
  for (const Contact& contact : *made.contacts) {
    if (!contact.pushes()) continue;
    for (int k = 0; k < contact.nodes; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const std::size_t n = contact.node[at];
      if (hand_[n] < 0) continue;
      Grasp& grasp = list_[static_cast<std::size_t>(hand_[n])];
      if (!grasp.pins) continue;
      grasp.push(made.state.position.at(n), grasp.origin(part_.end),
                 (made.h / made.scale * contact.weight[at]) * (contact.push * contact.normal + contact.slide));
    }
  }
}

void Grasps::countSprings(Grasp& grasp, const ClothState& state) noexcept {
  const Vec3 origin = grasp.origin(part_.end);
  Vec3 sum = Vec3::Zero();
  for (const HeldNode& held : grasp.held) {
    const Vec3 force = grasp.springs.forceAt(held, state, part_);
    grasp.push(state.position.at(held.node), origin, -part_.h * force);
    sum += force;
  }
  grasp.springs.substepAccepted(grasp.held, sum.norm());
  slide(grasp, state);
}

// Places slide after the nodes, until the springs pull with what the pads can hold.
void Grasps::slide(Grasp& grasp, const ClothState& state) noexcept {
  const double kept = grasp.springs.kept(grasp.held, state.position, part_);
  if (kept == 1.0) return;
  grasp.slid = true;
  const Pose now = between(grasp.from, grasp.to, part_.end);
  double way = 0.0;
  for (HeldNode& held : grasp.held) {
    const Vec3 shift = (1.0 - kept) * (state.position.at(held.node) - HoldSprings::targetOf(held, part_.end));
    const Vec3 local = now.orientation.conjugate() * shift;
    held.place += local;
    held.begin += grasp.from.orientation * local;
    held.end += grasp.to.orientation * local;
    way += shift.norm();
  }
  grasp.slipped += way / static_cast<double>(grasp.held.size());
}

// Cloth has slid: what has left the region is free, what has come into it is held.
void Grasps::changeHeld(Grasp& grasp, const ClothState& state) noexcept {
  const auto isInside = [&](std::size_t n) {
    return isInRegion(grasp.params, toLocal(grasp.from, state.position.at(n)));
  };
  std::size_t left = 0;
  for (const HeldNode& held : grasp.held) {
    if (isInside(held.node)) grasp.held[left++] = held;
  }
  grasp.held.resize(left);
  const Grid& grid = pattern_.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (std::size_t n = grid.index(i, 0); n < grid.index(i, grid.columns); ++n) {
      if (!isFree(n) || !isInside(n)) continue;
      HeldNode held;
      held.node = n;
      held.place = toLocal(grasp.from, state.position.at(n));
      held.begin = held.end = state.position.at(n);
      held.velocity = state.velocity.at(n);
      grasp.held.push_back(held);
    }
  }
  std::sort(grasp.held.begin(), grasp.held.end(), [](const HeldNode& a, const HeldNode& b) { return a.node < b.node; });
}

bool Grasps::endFrame(const FrameEnd& frame, ClothState& state) noexcept {
  PinMoves::endFrame(frame, state);
  bool ends = false;
  for (Grasp& grasp : list_) {
    if (!grasp.holds()) continue;
    const Vec3 pull = grasp.counted > 0.0 ? Vec3(grasp.impulse / grasp.counted) : grasp.force;
    if (grasp.counted > 0.0) {
      grasp.force = withinNumbers(pull);
      grasp.torque = withinNumbers(grasp.angular / grasp.counted);
    }
    grasp.from = frame.share < 1.0 ? between(grasp.from, grasp.to, frame.share) : grasp.to;
    // Written so that pulls beyond numbers break it.
    if (grasp.params.break_force <= kLargest && !(pull.stableNorm() < grasp.params.break_force)) {
      grasp.end = GraspEnd::kBroken;
    } else if (grasp.slid) {
      changeHeld(grasp, state);
      note();  // before another hand grasps what comes into its region
      if (!grasp.holds()) grasp.end = GraspEnd::kSlippedOut;
    }
    ends = ends || grasp.end != GraspEnd::kNone;
  }
  for (Grasp& grasp : list_) {
    if (ends && grasp.end != GraspEnd::kNone) release(grasp);
  }
  if (ends) note();
  return ends;
}

}  // namespace curtain
