// SPDX-License-Identifier: BSD-3-Clause
#include <set>
#include <utility>

#include "curtain_sim/grasp.h"
#include "scene/checks.h"
#include "scene/range_checker.h"

namespace curtain {
namespace {

void checkNodes(const GraspParams& grasp, const ClothParams& cloth, const std::string& key, ProblemLog& log) {
  if (grasp.nodes.empty() && log.good(key)) log.add(key, "must list at least one node");
  std::set<std::pair<int, int>> seen;
  for (std::size_t k = 0; k < grasp.nodes.size(); ++k) {
    const std::string item = itemKey(key, k);
    const NodeIndex& node = grasp.nodes[k];
    checkNodeOnGrid(node, cloth, item, log);
    if (!seen.emplace(node.row, node.column).second) log.add(item, "must be listed once");
  }
}

}  // namespace

void checkHold(const GraspParams& grasp, const ClothParams& cloth, const std::string& key, ProblemLog& log) {
  if (grasp.region != GraspRegion::kNodes || !log.good(joinKey(key, "region"))) return;
  checkNodes(grasp, cloth, joinKey(key, "nodes"), log);
  if (grasp.pinch_force <= kLargest)
    log.add(joinKey(key, "pinch_force"), "needs a sphere or a box: listed nodes have no edge to slide out of");
}

std::vector<Problem> validate(const GraspParams& grasp, const ClothParams& cloth, const std::string& key) {
  ProblemLog log;
  RangeChecker checker(key, log);
  visitFields(checker, grasp);
  checkHold(grasp, cloth, key, log);
  return log.problems();
}

}  // namespace curtain
