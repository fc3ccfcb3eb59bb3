// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/grasps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "scene/ranges.h"

namespace curtain {
namespace {

// How far cloth between two pads moves before it slides [m]: half of the 1e-4 m that a held node may be off.
constexpr double kPresliding = 5e-5;
// Share of the cloth's mass that a hand which gives way moves with it, as drag_force.cpp has it.
constexpr double kHeldShare = 0.25;

Vec3 toWorld(const Pose& pose, const Vec3& local) noexcept { return pose.position + pose.orientation * local; }
Vec3 toLocal(const Pose& pose, const Vec3& world) noexcept {
  return pose.orientation.conjugate() * (world - pose.position);
}

Pose normalised(const Pose& pose) noexcept { return {pose.position, pose.orientation.normalized()}; }

Pose between(const Pose& from, const Pose& to, double share) noexcept {
  return {from.position + share * (to.position - from.position), from.orientation.slerp(share, to.orientation)};
}

// at: in the gripper's frame [m].
bool isInRegion(const GraspParams& grasp, const Vec3& at) noexcept {
  const Vec3 local = toLocal(grasp.place, at);
  if (grasp.region == GraspRegion::kSphere) return local.norm() <= grasp.radius;
  return (2.0 * local.cwiseAbs() - grasp.size).maxCoeff() <= 0.0;
}

bool isRigid(const GraspParams& grasp) noexcept { return !(grasp.stiffness <= kLargest || grasp.pinch_force <= kLargest); }

std::string textOf(const NodeIndex& node) {
  return "[" + std::to_string(node.row) + ", " + std::to_string(node.column) + "]";
}

}  // namespace

Grasps::Grasps(const Scene& scene, const ClothPattern& pattern)
    : scene_(scene),
      pattern_(pattern),
      scene_pins_(pattern.pinned),
      total_mass_(std::accumulate(pattern.mass.begin(), pattern.mass.end(), 0.0)),
      pinned_(pattern.grid.size(), 0),
      loaded_(pattern.grid.size(), 0),
      hand_(pattern.grid.size(), -1) {}

bool Grasps::Grasp::moves() const noexcept {
  return holds() &&
         !(from.position == to.position && from.orientation.coeffs() == to.orientation.coeffs());
}

std::size_t Grasps::indexOf(const std::string& id) const noexcept {
  const auto found = std::find_if(list_.begin(), list_.end(), [&](const Grasp& grasp) { return grasp.params.id == id; });
  return static_cast<std::size_t>(found - list_.begin());
}

// After the list has changed, or who is held.
void Grasps::note() noexcept {
  std::fill(pinned_.begin(), pinned_.end(), std::uint8_t{0});
  std::fill(hand_.begin(), hand_.end(), -1);
  holding_ = 0;
  for (std::size_t g = 0; g < list_.size(); ++g) {
    holding_ += list_[g].holds() ? 1 : 0;
    for (const HeldNode& held : list_[g].held) {
      hand_[held.node] = static_cast<int>(g);
      pinned_[held.node] = list_[g].pins ? 1 : 0;
    }
  }
}

// ---- Taking hold and letting go

void Grasps::listNodes(const GraspParams& grasp, std::vector<std::size_t>& nodes,
                       std::vector<Problem>& problems) const {
  for (std::size_t k = 0; k < grasp.nodes.size(); ++k) {
    const std::size_t n = pattern_.grid.index(grasp.nodes[k]);
    const std::string key = "grasp.nodes[" + std::to_string(k) + "]", node = "node " + textOf(grasp.nodes[k]);
    if (hand_[n] >= 0)
      problems.push_back({key, node + " is held already, by '" + list_[static_cast<std::size_t>(hand_[n])].params.id + "'"});
    else if (scene_pins_[n] == kPinned)
      problems.push_back({key, node + " is pinned by the scene"});
    else if (scene_pins_[n] == kCarrier)
      problems.push_back({key, node + " hangs on the rail"});
    nodes.push_back(n);
  }
  std::sort(nodes.begin(), nodes.end());
}

std::vector<Problem> Grasps::find(const GraspParams& grasp, const Field3& position,
                                  std::vector<std::size_t>& nodes) const {
  std::vector<Problem> problems;
  if (holds(grasp.id)) return {{"grasp.id", "'" + grasp.id + "' holds the cloth already: release it first"}};
  if (scene_.solver.method == Method::kPaper && (!isRigid(grasp) || grasp.break_force <= kLargest)) {
    return {{"grasp", "can have a stiffness, break_force or pinch_force only where pulls are known: not with method paper"}};
  }
  if (grasp.region == GraspRegion::kNodes) {
    listNodes(grasp, nodes, problems);
    return problems;
  }
  const Grid& grid = pattern_.grid;
  const Pose frame = normalised(grasp.frame);
  const Vec3 centre = toWorld(frame, grasp.place.position);
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      if (!isFree(n)) continue;
      const Vec3 at = position.at(n);
      nearest = std::min(nearest, (at - centre).norm());
      if (isInRegion(grasp, toLocal(frame, at))) nodes.push_back(n);
    }
  }
  if (!nodes.empty()) return problems;
  const std::string where = std::isfinite(nearest)
                                ? "the nearest is " + formatNumber(nearest) + " m from its centre"
                                : "all of the cloth's are pinned or held";
  return {{"grasp.region", "holds no free node: " + where}};
}

// What follows from its parameters.
void Grasps::prepare(Grasp& grasp) const {
  const GraspParams& params = grasp.params;
  grasp.pins = isRigid(params);
  if (grasp.pins) return;
  double most = std::numeric_limits<double>::infinity();
  if (params.pinch_force <= kLargest) {
    most = 2.0 * params.friction * params.pinch_force;
    grasp.held.reserve(pattern_.grid.nodeCount());  // for what slides in
  }
  // Without a stiffness of the hand, that of the cloth between the pads; it needs no damper, since its implicit part
  // damps it far beyond the critical.
  if (params.stiffness <= kLargest) {
    const double share = 1.0 / static_cast<double>(grasp.taken);
    const double damping = 2.0 * std::sqrt(params.stiffness * kHeldShare * total_mass_);
    grasp.springs = {share * params.stiffness, share * damping, most, total_mass_};
  } else {
    grasp.springs = {most / kPresliding, 0.0, most, total_mass_};
  }
}

void Grasps::add(const GraspParams& params, const std::vector<std::size_t>& nodes, ClothState& state) {
  Grasp grasp;
  grasp.params = params;
  grasp.params.frame = grasp.from = grasp.to = normalised(params.frame);
  grasp.params.place = normalised(params.place);
  grasp.taken = nodes.size();
  prepare(grasp);
  for (const std::size_t n : nodes) {
    HeldNode held;
    held.node = n;
    held.place = toLocal(grasp.from, state.position.at(n));
    held.begin = held.end = state.position.at(n);
    held.velocity = state.velocity.at(n);
    if (grasp.pins) state.velocity.set(n, Vec3::Zero());
    grasp.held.push_back(held);
  }
  const std::size_t known = indexOf(params.id);
  if (known < list_.size())
    list_[known] = std::move(grasp);
  else
    list_.push_back(std::move(grasp));
  note();
}

void Grasps::release(Grasp& grasp, PinMoves& pins) noexcept {
  for (const HeldNode& held : grasp.held) pins.letGo(held.node);
  grasp.held.clear();
}

bool Grasps::remove(const std::string& id, PinMoves& pins) {
  const std::size_t known = indexOf(id);
  if (known == list_.size()) return false;
  release(list_[known], pins);
  list_.erase(list_.begin() + static_cast<std::ptrdiff_t>(known));
  note();
  return true;
}

bool Grasps::clear(PinMoves& pins) {
  if (list_.empty()) return false;
  for (Grasp& grasp : list_) release(grasp, pins);
  list_.clear();
  note();
  return true;
}

void Grasps::letGoOfEnded(PinMoves& pins) noexcept {
  for (Grasp& grasp : list_) {
    if (grasp.end != GraspEnd::kNone) release(grasp, pins);
  }
  note();
}

bool Grasps::move(const std::string& id, const Pose& pose) {
  if (!holds(id)) return false;
  list_[indexOf(id)].to = normalised(pose);
  return true;
}

void Grasps::holdWhereTheyAre(const ClothState& state) noexcept {
  for (Grasp& grasp : list_) {
    for (HeldNode& held : grasp.held) {
      held.place = toLocal(grasp.from, state.position.at(held.node));
      held.velocity = Vec3::Zero();
    }
  }
}

GraspState Grasps::stateOf(const std::string& id) const {
  const Grasp& grasp = list_[indexOf(id)];
  GraspState state;
  const auto stride = static_cast<std::size_t>(pattern_.grid.stride);
  for (const HeldNode& held : grasp.held)
    state.nodes.push_back({static_cast<int>(held.node / stride), static_cast<int>(held.node % stride)});
  state.force = grasp.force;
  state.torque = grasp.torque;
  state.slipped = grasp.slipped;
  state.end = grasp.end;
  return state;
}

std::vector<std::string> Grasps::ids() const {
  std::vector<std::string> ids;
  for (const Grasp& grasp : list_) ids.push_back(grasp.params.id);
  return ids;
}

// ---- A frame

bool Grasps::anyMoves() const noexcept {
  return std::any_of(list_.begin(), list_.end(), [](const Grasp& grasp) { return grasp.moves(); });
}

bool Grasps::anySprings() const noexcept {
  return any() && std::any_of(list_.begin(), list_.end(), [](const Grasp& grasp) { return grasp.holds() && !grasp.pins; });
}

void Grasps::movePins(PinMoves& pins) const noexcept {
  for (const Grasp& grasp : list_) {
    if (!grasp.pins || !grasp.moves()) continue;
    for (const HeldNode& held : grasp.held) pins.move(held.node, toWorld(grasp.to, held.place));
  }
}

// The nodes that a hand pins change their velocity here; what that takes, the hand has to give.
void Grasps::begin(const ClothState& state, double frame_rate) noexcept {
  part_.frame_rate = frame_rate;
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
}

void Grasps::setSubstep(double done, double h) noexcept {
  part_.h = h;
  part_.end = (done + h) * part_.frame_rate;
}

void Grasps::addForces(const ClothState& state, Field3& force, Field& damping) noexcept {
  for (Grasp& grasp : list_) {
    if (grasp.holds() && !grasp.pins) grasp.springs.addForces(grasp.held, state, part_, force, damping);
  }
}

void Grasps::keepForces(const Field3& force) noexcept {
  for (Grasp& grasp : list_) {
    for (HeldNode& held : grasp.held) held.others = force.at(held.node);
  }
}

void Grasps::restoreForces(Field3& force) const noexcept {
  for (const Grasp& grasp : list_) {
    for (const HeldNode& held : grasp.held) {
      if (!grasp.pins) force.set(held.node, held.others);
    }
  }
}

void Grasps::count(const ClothState& state, const NodeForces& forces, const ExactSolver* links,
                   const Contacts* contacts, double scale) noexcept {
  for (Grasp& grasp : list_) {
    if (!grasp.holds()) continue;
    grasp.counted += part_.h;
    if (!grasp.pins)
      countSprings(grasp, state);
    else if (links != nullptr)
      countPinned(grasp, state, forces, *links, scale);
  }
  if (links != nullptr && contacts != nullptr) countContacts(state, *contacts, scale);
}

// All that acts on a pinned node acts on the hand.
void Grasps::countPinned(Grasp& grasp, const ClothState& state, const NodeForces& forces, const ExactSolver& links,
                         double scale) noexcept {
  const auto stride = static_cast<std::size_t>(pattern_.grid.stride);
  const Field3& others = links.forcesWithBending() != nullptr ? *links.forcesWithBending() : *forces.force;
  const Vec3 origin = grasp.origin(part_.end);
  for (const HeldNode& held : grasp.held) {
    const std::size_t n = held.node;
    Vec3 sum = others.at(n);
    if (scale != 0.0) sum += links.pullAt(static_cast<int>(n / stride), static_cast<int>(n % stride)) / scale;
    if (forces.has_damping) sum -= forces.damping[n] * state.velocity.at(n);
    grasp.push(state.position.at(n), origin, part_.h * sum);
  }
}

void Grasps::countContacts(const ClothState& state, const Contacts& contacts, double scale) noexcept {
  for (const Contact& contact : contacts) {
    if (!contact.pushes()) continue;
    for (int k = 0; k < contact.nodes; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const std::size_t n = contact.node[at];
      if (pinned_[n] == 0) continue;
      Grasp& grasp = list_[static_cast<std::size_t>(hand_[n])];
      grasp.push(state.position.at(n), grasp.origin(part_.end),
                 (part_.h / scale * contact.weight[at]) * (contact.push * contact.normal + contact.slide));
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
  grasp.springs.taken(grasp.held, sum.norm());
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
  const auto isInside = [&](std::size_t n) { return isInRegion(grasp.params, toLocal(grasp.from, state.position.at(n))); };
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

bool Grasps::end(double share, const ClothState& state) noexcept {
  bool ends = false;
  for (Grasp& grasp : list_) {
    if (!grasp.holds()) continue;
    if (grasp.counted > 0.0) {
      grasp.force = grasp.impulse / grasp.counted;
      grasp.torque = grasp.angular / grasp.counted;
    }
    grasp.from = share < 1.0 ? between(grasp.from, grasp.to, share) : grasp.to;
    // Written so that pulls beyond numbers break it.
    if (grasp.params.break_force <= kLargest && !(grasp.force.norm() < grasp.params.break_force)) {
      grasp.end = GraspEnd::kBroken;
    } else if (grasp.slid) {
      changeHeld(grasp, state);
      note();  // before another hand takes what comes into its region
      if (!grasp.holds()) grasp.end = GraspEnd::kSlippedOut;
    }
    ends = ends || grasp.end != GraspEnd::kNone;
  }
  return ends;
}

}  // namespace curtain
