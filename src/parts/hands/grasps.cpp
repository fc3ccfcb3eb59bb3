// SPDX-License-Identifier: BSD-3-Clause
#include "parts/hands/grasps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "cloth/archive_params.h"
#include "scene/ranges.h"

namespace curtain {
namespace {

// How far cloth moves in a hand before it slides, or is lost [m]: half of the 1e-4 m that a held node may be off.
constexpr double kPresliding = 5e-5;
// Pulls of more than so many times the cloth's weight may move it further: pads that are stiffer by far than all that
// pulls at them are hard to solve for.
constexpr double kMaxWeights = 10.0, kStandardGravity = 9.81;
// Share of the cloth's mass that a hand which gives way moves with it, as drag_force.cpp has it.
constexpr double kHeldShare = 0.25;

// It neither gives way nor loses the cloth. Else it needs some elasticity: between two pins, what straight links pull
// with has no one answer.
bool isRigid(const GraspParams& grasp) noexcept {
  return !(grasp.stiffness <= kLargest || grasp.pinch_force <= kLargest || grasp.break_force <= kLargest);
}

std::string textOf(const NodeIndex& node) {
  return "[" + std::to_string(node.row) + ", " + std::to_string(node.column) + "]";
}

}  // namespace

Grasps::Grasps(const Scene& scene, const ClothPattern& pattern)
    : PinMoves(scene, pattern, true),
      total_mass_(std::accumulate(pattern.mass.begin(), pattern.mass.end(), 0.0)),
      loaded_(pattern.grid.size(), 0),
      hand_(pattern.grid.size(), -1) {
  nodes_.reserve(pattern.grid.nodeCount());
}

bool Grasps::Grasp::moves() const noexcept {
  return holds() && !(from.position == to.position && from.orientation.coeffs() == to.orientation.coeffs());
}

std::size_t Grasps::indexOf(const std::string& id) const noexcept {
  const auto found =
      std::find_if(list_.begin(), list_.end(), [&](const Grasp& grasp) { return grasp.params.id == id; });
  return static_cast<std::size_t>(found - list_.begin());
}

// After the list has changed, or who is held.
void Grasps::note() noexcept {
  std::fill(hand_.begin(), hand_.end(), -1);
  holding_ = 0;
  for (std::size_t g = 0; g < list_.size(); ++g) {
    holding_ += list_[g].holds() ? 1 : 0;
    for (const HeldNode& held : list_[g].held) hand_[held.node] = static_cast<int>(g);
  }
}

void Grasps::listNodes(const GraspParams& grasp, std::vector<std::size_t>& nodes,
                       std::vector<Problem>& problems) const {
  for (std::size_t k = 0; k < grasp.nodes.size(); ++k) {
    const std::size_t n = pattern_.grid.index(grasp.nodes[k]);
    const std::string key = "grasp.nodes[" + std::to_string(k) + "]", node = "node " + textOf(grasp.nodes[k]);
    if (hand_[n] >= 0)
      problems.push_back(
          {key, node + " is held already, by '" + list_[static_cast<std::size_t>(hand_[n])].params.id + "'"});
    else if (pattern_.scene_pins[n] == kPinned)
      problems.push_back({key, node + " is pinned by the scene"});
    else if (pattern_.scene_pins[n] == kGuided)
      problems.push_back({key, node + " hangs on the rail"});
    nodes.push_back(n);
  }
  std::sort(nodes.begin(), nodes.end());
}

std::vector<Problem> Grasps::find(const GraspParams& grasp, const Field3& position,
                                  std::vector<std::size_t>& nodes) const {
  std::vector<Problem> problems;
  const std::size_t known = indexOf(grasp.id);
  if (known < list_.size() && list_[known].end == GraspEnd::kWaiting)
    return {{"grasp.id", "'" + grasp.id + "' is a hand of the scene, which begins later: release it first"}};
  if (holds(grasp.id)) return {{"grasp.id", "'" + grasp.id + "' holds the cloth already: release it first"}};
  if (scene_.solver.method == Method::kPaper && !isRigid(grasp)) {
    return {{"grasp",
             "can have a stiffness, break_force or pinch_force only where pulls are known: not with method paper"}};
  }
  if (grasp.region == GraspRegion::kNodes) {
    listNodes(grasp, nodes, problems);
    return problems;
  }
  listFree(grasp, position, nodes);
  if (!nodes.empty()) return problems;
  const Vec3 centre = toWorld(normalised(grasp.frame), grasp.place.position);
  double nearest = std::numeric_limits<double>::infinity();
  forEachFree([&](std::size_t n) { nearest = std::min(nearest, (position.at(n) - centre).norm()); });
  const std::string where = std::isfinite(nearest) ? "the nearest is " + formatNumber(nearest) + " m from its centre"
                                                   : "all of the cloth's are pinned or held";
  return {{"grasp.region", "holds no free node: " + where}};
}

// Free nodes that it would take, row by row.
void Grasps::listFree(const GraspParams& grasp, const Field3& position, std::vector<std::size_t>& nodes) const {
  if (grasp.region == GraspRegion::kNodes) {
    for (const NodeIndex& node : grasp.nodes) {
      if (isFree(pattern_.grid.index(node))) nodes.push_back(pattern_.grid.index(node));
    }
    std::sort(nodes.begin(), nodes.end());
    return;
  }
  const Pose frame = normalised(grasp.frame);
  forEachFree([&](std::size_t n) {
    if (isInRegion(grasp, toLocal(frame, position.at(n)))) nodes.push_back(n);
  });
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
    const double share = 1.0 / static_cast<double>(std::max<std::size_t>(grasp.taken, 1));
    const double damping = 2.0 * std::sqrt(params.stiffness * kHeldShare * total_mass_);
    grasp.springs = {share * params.stiffness, share * damping, most, total_mass_};
  } else {
    const double bears = std::min({most, params.break_force, kMaxWeights * kStandardGravity * total_mass_});
    grasp.springs = {bears / kPresliding, 0.0, most, total_mass_};
  }
}

void Grasps::add(const GraspParams& params, const std::vector<std::size_t>& nodes, ClothState& state) {
  const std::size_t known = indexOf(params.id);
  if (known == list_.size()) list_.emplace_back();
  Grasp& grasp = list_[known];
  grasp = Grasp();
  grasp.params = params;
  grasp.params.frame = normalised(params.frame);
  grasp.params.place = normalised(params.place);
  grasp.held.reserve(nodes.size());
  hold(grasp, nodes, state);
  note();
}

// Takes these nodes, with the gripper where its parameters have it.
void Grasps::hold(Grasp& grasp, const std::vector<std::size_t>& nodes, ClothState& state) noexcept {
  grasp.from = grasp.to = grasp.params.frame;
  grasp.taken = nodes.size();
  grasp.end = GraspEnd::kNone;
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
}

void Grasps::release(Grasp& grasp) noexcept {
  for (const HeldNode& held : grasp.held) letGo(held.node);
  grasp.held.clear();
}

void Grasps::remove(const std::string& id) {
  const std::size_t known = indexOf(id);
  release(list_[known]);
  list_.erase(list_.begin() + static_cast<std::ptrdiff_t>(known));
  note();
}

// Room for all that a hand of the scene may hold, which is taken within a frame.
void Grasps::reset(ClothState&) {
  removeAll();
  for (const HandParams& hand : scene_.hands) {
    Grasp grasp;
    grasp.params = hand.grasp;
    grasp.params.place = normalised(hand.grasp.place);
    grasp.end = GraspEnd::kWaiting;
    grasp.held.reserve(pattern_.grid.nodeCount());
    follow(grasp);
    list_.push_back(std::move(grasp));
  }
  note();
}

// Of a hand of the scene: its motion. Its gripper is where that has it at the start.
void Grasps::follow(Grasp& grasp) const {
  const auto same = [&](const HandParams& hand) { return hand.grasp.id == grasp.params.id; };
  const auto found = std::find_if(scene_.hands.begin(), scene_.hands.end(), same);
  if (found == scene_.hands.end()) return;
  const GraspParams& params = found->grasp;
  const double wide = params.region == GraspRegion::kSphere ? params.radius : 0.5 * params.size.norm();
  const double reach = params.region == GraspRegion::kNodes ? 0.0 : params.place.position.norm() + wide;
  grasp.hand = &*found;
  grasp.motion = {normalised(params.frame), found->motion, reach};
}

void Grasps::removeAll() noexcept {
  list_.clear();
  clear();
  note();
}

bool Grasps::moveTo(const std::string& id, const Pose& pose) {
  if (!holds(id)) return false;
  list_[indexOf(id)].to = normalised(pose);
  return true;
}

void Grasps::placed(const ClothState&, ClothState& state) noexcept {
  for (Grasp& grasp : list_) {
    for (HeldNode& held : grasp.held) {
      held.place = toLocal(grasp.from, state.position.at(held.node));
      held.velocity = Vec3::Zero();
    }
  }
}

void Grasps::pin(std::vector<std::uint8_t>& pinned) const noexcept {
  for (const Grasp& grasp : list_) {
    for (const HeldNode& held : grasp.held) pinned[held.node] = grasp.pins ? 1 : 0;
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

// ---- Serialization

void Grasps::serializeGrasp(Archive& archive, Grasp& grasp) {
  serializeParams(archive, grasp.params, wholeCloth(scene_));
  const auto serializePose = [&](const char* name, Pose& pose) {
    archive.finite(name, pose);
    archive.require(std::abs(pose.orientation.norm() - 1.0) <= 1e-3, "must have a unit quaternion");
  };
  serializePose("from", grasp.from);
  serializePose("to", grasp.to);
  bool scripted = grasp.hand != nullptr;
  archive.atOnce([&] { archive.flag("scripted", scripted); });
  archive.integer("taken", grasp.taken, 0, 1 << 30);
  double pull = grasp.springs.pull();
  archive.atOnce([&] { archive.number("pull", pull); });
  archive.list("held", grasp.held, [&](HeldNode& held) {
    archive.node("node", held.node, pattern_.grid);
    archive.require(pattern_.scene_pins[held.node] == kFree, "must be a node that nothing else holds");
    archive.finite("place", held.place);
    archive.finite("velocity", held.velocity);
  });
  archive.finite("force", grasp.force);
  archive.finite("torque", grasp.torque);
  archive.within("slipped", grasp.slipped, 0.0, std::numeric_limits<double>::max());
  archive.integer("end", grasp.end, 0, 5);
  archive.require(grasp.holds() == (grasp.end == GraspEnd::kNone), "must hold nodes unless it has ended");
  if (!archive.loads()) return;
  if (scripted) {
    follow(grasp);
    archive.require(grasp.hand != nullptr, "must be a hand of the scene");
    grasp.held.reserve(pattern_.grid.nodeCount());
  }
  archive.require(scripted || grasp.end < GraspEnd::kWaiting, "must be a hand of the scene");
  archive.require(grasp.taken > 0 || !grasp.holds(), "must have taken what it holds");
  prepare(grasp);
  grasp.springs.setPull(pull);
  for (const HeldNode& held : grasp.held) {
    archive.require(loaded_[held.node] == 0, "must hold nodes that no other holds");
    loaded_[held.node] = grasp.pins ? 2 : 1;
  }
}

void Grasps::serialize(Archive& archive) {
  std::vector<std::string> known;
  std::fill(loaded_.begin(), loaded_.end(), std::uint8_t{0});
  archive.list("grasps", list_, [&](Grasp& grasp) {
    serializeGrasp(archive, grasp);
    archive.require(std::find(known.begin(), known.end(), grasp.params.id) == known.end(),
                    "must have ids of their own");
    known.push_back(grasp.params.id);
  });
  PinMoves::serialize(archive);
}

void Grasps::resume() {
  note();
  PinMoves::resume();
}

}  // namespace curtain
