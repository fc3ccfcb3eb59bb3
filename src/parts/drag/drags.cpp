// SPDX-License-Identifier: BSD-3-Clause
#include "parts/drag/drags.h"

#include "cloth/archive_params.h"

namespace curtain {

Drags::Drags(const Scene& scene, const ClothPattern& pattern) : scene_(scene), pattern_(pattern) {
  for (const DragParams& drag : scene.drag) set(drag);
}

void Drags::set(const DragParams& drag) {
  DragForce force(drag, pattern_);
  const auto old = placeOf(drags_.params, drag.id);
  if (old && !force.node() && drags_.list[*old].node()) force.grasp(*drags_.list[*old].node(), pattern_);
  drags_.put(std::move(force));
}

void Drags::reset(ClothState&) {
  clear();
  for (const DragParams& drag : scene_.drag) set(drag);
}

void Drags::serialize(Archive& archive) {
  std::vector<std::pair<DragParams, std::optional<NodeIndex>>> held;  // with the node that it pulls at
  for (const DragForce& drag : drags_.list) held.push_back({drag.params(), drag.node()});
  archive.atOnce([&] {
    archive.list("drags", held, [&](auto& one) {
      serializeParams(archive, one.first, wholeCloth(scene_));
      archive.optional("holds", one.second, NodeIndex(),
                       [&](NodeIndex& node) { archive.node("node", node, pattern_.grid); });
    });
  });
  if (!archive.loads()) return;
  Sources<DragForce, DragParams> loaded;
  for (const auto& [params, node] : held) {
    DragForce drag(params, pattern_);
    if (node) drag.grasp(*node, pattern_);
    loaded.put(std::move(drag));
  }
  archive.put(drags_, std::move(loaded));
}

bool Drags::wakes(const FrameBegin& begin, const ClothState&) const noexcept {
  const auto changes = [&](const DragForce& drag) {
    return changesWithin(drag.params(), begin.from, begin.to) || drag.movesWithin(begin.from, begin.to);
  };
  return !drags_.list.empty() && std::any_of(drags_.list.begin(), drags_.list.end(), changes);
}

void Drags::announce(const ClothState&, ForceSum& sum) noexcept {
  for (const DragForce& drag : drags_.list) {
    if (!drag.actsAt(sum.time)) continue;
    sum.acts = true;
    sum.damps = sum.damps || drag.damps();
  }
}

void Drags::addForces(const ClothState& state, ForceSum& sum) noexcept {
  for (DragForce& drag : drags_.list) {
    if (drag.actsAt(sum.time))
      drag.addForces(pattern_, state.position, sum.time + sum.h, sum.h + state.velocity_age, sum.force, sum.damping);
  }
}

bool Drags::explain(const ClothState&, double time, Plan& plan) const {
  if (drags_.list.empty()) plan.push_back({"drags", false, "there are none"});
  bool acts = false;
  for (const DragParams& drag : drags_.params) {
    const std::string why = whyNotAt(drag, time);
    plan.push_back({"drag '" + drag.id + "'", why.empty(),
                    !why.empty()                        ? why
                    : drag.target || !drag.path.empty() ? "pulls by a spring"
                                                        : "pulls"});
    acts = acts || why.empty();
  }
  return acts;
}

}  // namespace curtain
