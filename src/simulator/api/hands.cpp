// SPDX-License-Identifier: BSD-3-Clause
//
// The public interface of hands that hold the cloth.
#include <array>

#include "scene/ranges.h"
#include "simulator/simulator_impl.h"

namespace curtain {

const char* toString(GraspEnd end) {
  constexpr std::array<const char*, 6> kNames = {"holds", "broken", "slipped_out", "waiting", "missed", "released"};
  return kNames.at(static_cast<std::size_t>(end));
}

std::string describeFailure(const HandParams& hand, GraspEnd end) {
  const std::string who = "hand '" + hand.grasp.id + "' ";
  if (end == GraspEnd::kMissed)
    return who + "took nothing at " + formatNumber(hand.start) + " s: no free node was where it took hold";
  if (end == GraspEnd::kBroken) return who + "lost the cloth: the pull reached its break_force";
  return end == GraspEnd::kSlippedOut ? who + "lost the cloth: it slid out between the pads" : "";
}

std::vector<Problem> Simulator::setGrasp(const GraspParams& grasp) {
  Impl& im = *impl_;
  std::vector<Problem> problems = validate(grasp, wholeCloth(im.scene), "grasp");
  if (!problems.empty()) return problems;
  std::vector<std::size_t> nodes;
  problems = im.motion.parts.hands.find(grasp, im.motion.state.position, nodes);
  if (!problems.empty()) return problems;
  im.changePins([&] { im.motion.parts.hands.add(grasp, nodes, im.motion.state); });
  return problems;
}

bool Simulator::moveGrasp(const std::string& id, const Pose& frame) {
  const double norm = frame.orientation.norm();  // NaN fails
  if (!isPlace(frame.position) || !(norm > 0.0 && norm < 1e9)) return false;
  return impl_->motion.parts.hands.moveTo(id, frame);
}

bool Simulator::releaseGrasp(const std::string& id) {
  Impl& im = *impl_;
  if (!im.motion.parts.hands.has(id)) return false;
  im.changePins([&] { im.motion.parts.hands.remove(id); });
  return true;
}

void Simulator::releaseAllGrasps() {
  Impl& im = *impl_;
  if (im.motion.parts.hands.ids().empty()) return;
  im.changePins([&] { im.motion.parts.hands.removeAll(); });
}

std::optional<GraspState> Simulator::graspState(const std::string& id) const {
  if (!impl_->motion.parts.hands.has(id)) return std::nullopt;
  return impl_->motion.parts.hands.stateOf(id);
}

std::vector<std::string> Simulator::grasps() const { return impl_->motion.parts.hands.ids(); }

}  // namespace curtain
