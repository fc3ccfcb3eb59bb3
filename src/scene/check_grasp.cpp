// SPDX-License-Identifier: BSD-3-Clause
#include <set>
#include <utility>

#include "curtain_sim/grasp.h"
#include "scene/checks.h"
#include "scene/range_checker.h"

namespace curtain {
namespace {

// What a hand can bear.
Range strength() { return {kSmallest, kLargest, false, true}; }

void checkNodes(const GraspParams& grasp, const ClothParams& cloth, const std::string& key, ProblemLog& log) {
  if (grasp.nodes.empty()) log.add(joinKey(key, "nodes"), "must list at least one node");
  std::set<std::pair<int, int>> seen;
  for (std::size_t k = 0; k < grasp.nodes.size(); ++k) {
    const std::string item = itemKey(joinKey(key, "nodes"), k);
    const NodeIndex& node = grasp.nodes[k];
    checkNodeOnGrid(node, cloth, item, log);
    if (!seen.emplace(node.row, node.column).second) log.add(item, "must be listed once");
  }
}

}  // namespace

std::vector<Problem> validate(const GraspParams& grasp, const ClothParams& cloth, const std::string& key) {
  ProblemLog log;
  RangeChecker check(key, log);
  check.text("id", grasp.id);
  check.vector("frame.position", grasp.frame.position, anywhere());
  check.rotation("frame.orientation", grasp.frame.orientation);
  check.choice("region", grasp.region, {"sphere", "box", "nodes"});
  if (grasp.region == GraspRegion::kNodes) {
    checkNodes(grasp, cloth, key, log);
  } else {
    check.vector("place.position", grasp.place.position, anywhere());
    check.rotation("place.orientation", grasp.place.orientation);
    if (grasp.region == GraspRegion::kSphere) check.number("radius", grasp.radius, positive());
    if (grasp.region == GraspRegion::kBox) check.vector("size", grasp.size, positive());
  }
  check.number("stiffness", grasp.stiffness, strength());
  check.number("break_force", grasp.break_force, strength());
  check.number("pinch_force", grasp.pinch_force, strength());
  const bool pinches = grasp.pinch_force <= kLargest;
  check.number("friction", grasp.friction, pinches ? positive() : notNegative());
  if (pinches && grasp.region == GraspRegion::kNodes) {
    log.add(joinKey(key, "pinch_force"), "needs a sphere or a box: listed nodes have no edge to slide out of");
  }
  return log.problems();
}

}  // namespace curtain
