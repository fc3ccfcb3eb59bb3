// SPDX-License-Identifier: BSD-3-Clause
//
// Hands that hold the cloth. A node in a hand that does not give is pinned, and its moves are those of pins
// (step/pin_moves.h); others hang on springs (hold_springs.h). Changes by the user of who is pinned go through
// Simulator::Impl::changePins(). The hands of the scene are grasps like others, that wait for their time from the
// start.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "curtain_sim/grasp.h"
#include "obstacles/pose_curve.h"
#include "parts/hands/hold_springs.h"
#include "step/pin_moves.h"
#include "step/step.h"

namespace curtain {

// ---- Poses of a gripper's frame
inline Vec3 toWorld(const Pose& pose, const Vec3& local) noexcept { return pose.position + pose.orientation * local; }
inline Vec3 toLocal(const Pose& pose, const Vec3& world) noexcept {
  return pose.orientation.conjugate() * (world - pose.position);
}

inline Pose normalised(const Pose& pose) noexcept { return {pose.position, pose.orientation.normalized()}; }

inline Pose between(const Pose& from, const Pose& to, double share) noexcept {
  return {from.position + share * (to.position - from.position), from.orientation.slerp(share, to.orientation)};
}

/// at: in the gripper's frame [m].
inline bool isInRegion(const GraspParams& grasp, const Vec3& at) noexcept {
  const Vec3 local = toLocal(grasp.place, at);
  if (grasp.region == GraspRegion::kSphere) return local.norm() <= grasp.radius;
  return (2.0 * local.cwiseAbs() - grasp.size).maxCoeff() <= 0.0;
}

/// Not thread-safe. Allocates in the constructor, reset(), add() and serialize().
class Grasps final : public PinMoves {
 public:
  /// scene and pattern must outlive this.
  Grasps(const Scene& scene, const ClothPattern& pattern);

  /// Nodes that a valid grasp would take, or what keeps it from it.
  std::vector<Problem> find(const GraspParams& grasp, const Field3& position, std::vector<std::size_t>& nodes) const;
  /// Takes hold of these nodes, which are at rest from now on where the hand pins them.
  void add(const GraspParams& grasp, const std::vector<std::size_t>& nodes, ClothState& state);
  /// Lets go of the nodes of a grasp that there is, and forgets it.
  void remove(const std::string& id);
  /// The same of all.
  void removeAll() noexcept;
  /// The hand's pose at the next frame's end. False: none of this id holds.
  bool moveTo(const std::string& id, const Pose& pose);
  /// The grasp of this id, holding or ended; none: there is none.
  bool has(const std::string& id) const { return indexOf(id) < list_.size(); }
  bool holds(const std::string& id) const { return has(id) && list_[indexOf(id)].holds(); }
  /// Of a grasp that there is.
  GraspState stateOf(const std::string& id) const;
  std::vector<std::string> ids() const;

  void reset(ClothState&) override;
  /// Nodes were put elsewhere: they are held there.
  void placed(const ClothState& before, ClothState& state) noexcept override;
  void serialize(Archive& archive) override;
  void resume() override;
  void pin(std::vector<std::uint8_t>& pinned) const noexcept override;
  bool wakes(const FrameBegin& begin, const ClothState& state) const noexcept override;
  bool strains() const noexcept override { return any(); }
  bool reversible() const noexcept override { return !any(); }
  bool begins(const FrameBegin& begin) const noexcept override;
  void begun(const FrameBegin& begin, ClothState& state) noexcept override;
  bool prepareFrame(const FrameBegin& begin, ClothState& state) noexcept override;
  bool beginFrame(const FrameBegin& begin, ClothState& state) noexcept override;
  void announce(const ClothState& state, ForceSum& sum) noexcept override;
  void addForces(const ClothState& state, ForceSum& sum) noexcept override;
  void substepDone(const SubstepMade& made) noexcept override;
  bool endFrame(const FrameEnd& end, ClothState& state) noexcept override;

 private:
  struct Grasp {
    GraspParams params;
    Pose from, to;  // of the hand at the begin and at the end of the coming frame; begin() sets the nodes' ways
    std::vector<HeldNode> held;
    std::size_t taken = 0;  // nodes that it took first: they share its stiffness
    bool pins = true;
    HoldSprings springs;
    Vec3 impulse = Vec3::Zero(), angular = Vec3::Zero();  // on the hand in this frame [N s], [N m s]
    double counted = 0.0;                                 // time of it [s]
    bool slid = false;                                    // in this frame
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();     // mean of the last frame
    double slipped = 0.0;                                 // [m]
    GraspEnd end = GraspEnd::kNone;
    const HandParams* hand = nullptr;  // of the scene, or null
    ScriptedMotion motion;             // of such a one

    bool holds() const noexcept { return !held.empty(); }
    bool moves() const noexcept;
    bool hasSprings() const noexcept { return holds() && !pins; }
    Vec3 origin(double share) const noexcept { return from.position + share * (to.position - from.position); }
    void push(const Vec3& at, const Vec3& origin, const Vec3& given) noexcept {
      impulse += given;
      angular += (at - origin).cross(given);
    }
  };

  bool any() const noexcept { return holding_ > 0; }  // a hand holds something
  static constexpr double kTimeRounding = 1e-9;       // [s]
  bool isDue(const Grasp& grasp, double time) const noexcept;
  static bool isOver(const Grasp& grasp, double time) noexcept { return grasp.hand->end <= time + kTimeRounding; }
  void hold(Grasp& grasp, const std::vector<std::size_t>& nodes, ClothState& state) noexcept;
  void follow(Grasp& grasp) const;
  void listFree(const GraspParams& grasp, const Field3& position, std::vector<std::size_t>& nodes) const;
  std::size_t indexOf(const std::string& id) const noexcept;
  void prepare(Grasp& grasp) const;
  void listNodes(const GraspParams& grasp, std::vector<std::size_t>& nodes, std::vector<Problem>& problems) const;
  bool isFree(std::size_t node) const noexcept { return pattern_.scene_pins[node] == kFree && hand_[node] < 0; }
  template <typename Visit>
  void forEachFree(const Visit& visit) const {
    for (int i = 0; i < pattern_.grid.rows; ++i) {
      for (std::size_t n = pattern_.grid.index(i, 0); n < pattern_.grid.index(i, pattern_.grid.columns); ++n) {
        if (isFree(n)) visit(n);
      }
    }
  }
  void note() noexcept;
  void release(Grasp& grasp) noexcept;
  void countPinned(Grasp& grasp, const SubstepMade& made) noexcept;
  void countContacts(const SubstepMade& made) noexcept;
  void countSprings(Grasp& grasp, const ClothState& state) noexcept;
  void slide(Grasp& grasp, const ClothState& state) noexcept;
  void changeHeld(Grasp& grasp, const ClothState& state) noexcept;
  void serializeGrasp(Archive& archive, Grasp& grasp);

  bool willPin(std::size_t node) const noexcept override { return loaded_[node] == 2; }

  double total_mass_;  // [kg]
  std::vector<Grasp> list_;
  int holding_ = 0;
  std::vector<std::uint8_t> loaded_;  // by node, of what serialize() loads: 2: pinned, 1: held by a spring
  std::vector<int> hand_;             // by node: index of the grasp that holds it, or -1
  std::vector<std::size_t> nodes_;    // scratch of begun()
  FramePart part_;
};

}  // namespace curtain
