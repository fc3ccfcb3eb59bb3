// SPDX-License-Identifier: BSD-3-Clause
//
// The public interface of hands that hold the cloth.
#include "simulator/simulator_impl.h"

namespace curtain {

std::vector<Problem> Simulator::setGrasp(const GraspParams& grasp) {
  Impl& im = *impl_;
  std::vector<Problem> problems = validate(grasp, im.scene.cloth, "grasp");
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
