// SPDX-License-Identifier: BSD-3-Clause
//
// Hands that hold the cloth. A node in a hand that does not give is pinned, and its moves are those of pins
// (pin_moves.h); others hang on springs (parts/hands/hold_springs.h). What changes who is pinned goes through
// Simulator::Impl::repin().
//
//   grasps.cpp            who is held: setGrasp() finds the nodes and adds the grasp
//   grasps_frame.cpp      before a frame: movePins(), begin(), where the hands will be at its end;
//                         a substep: setSubstep(), addForces() of the springs; if it is accepted, count();
//                         after a frame: end(), pulls, who has slid out or in, which hands are torn
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cloth/pin_moves.h"
#include "curtain_sim/grasp.h"
#include "parts/hands/hold_springs.h"
#include "step/exact_solver.h"

namespace curtain {

/// Not thread-safe. Allocates in the constructor, add() and carry().
class Grasps {
 public:
  /// scene and pattern must outlive this.
  Grasps(const Scene& scene, const ClothPattern& pattern);

  /// A hand holds something.
  bool any() const noexcept { return holding_ > 0; }
  /// A hand is to move in the coming frame.
  bool anyMoves() const noexcept;
  /// By node: a hand pins it.
  const std::vector<std::uint8_t>& pinned() const noexcept { return pinned_; }
  /// ClothPattern::pinned without hands.
  const std::vector<std::uint8_t>& scenePins() const noexcept { return scene_pins_; }

  /// Nodes that a valid grasp would take, or what keeps it from it.
  std::vector<Problem> find(const GraspParams& grasp, const Field3& position, std::vector<std::size_t>& nodes) const;
  /// Takes hold of these nodes, which are at rest from now on where the hand pins them.
  void add(const GraspParams& grasp, const std::vector<std::size_t>& nodes, ClothState& state);
  /// Lets go of a grasp's nodes, and forgets it. False: there is none of this id.
  bool remove(const std::string& id, PinMoves& pins);
  /// The same of all. False: there were none.
  bool clear(PinMoves& pins);
  /// The hand's pose at the next frame's end. False: none of this id holds.
  bool move(const std::string& id, const Pose& pose);
  /// Nodes were put elsewhere: they are held there.
  void holdWhereTheyAre(const ClothState& state) noexcept;
  /// The grasp of this id, holding or ended; none: there is none.
  bool has(const std::string& id) const { return indexOf(id) < list_.size(); }
  bool holds(const std::string& id) const { return has(id) && list_[indexOf(id)].holds(); }
  bool holdsNode(std::size_t node) const noexcept { return hand_[node] >= 0; }
  /// Of a grasp that there is.
  GraspState stateOf(const std::string& id) const;
  std::vector<std::string> ids() const;

  /// Before a frame: moves of the nodes that hands pin.
  void movePins(PinMoves& pins) const noexcept;
  /// After PinMoves::start(): begins to count.
  void begin(const ClothState& state, double frame_rate) noexcept;
  /// The coming substep: h [s], from `done` [s] into the frame.
  void setSubstep(double done, double h) noexcept;
  /// Springs act: substeps have damping.
  bool anySprings() const noexcept;
  void addForces(const ClothState& state, Field3& force, Field& damping) noexcept;
  /// Air that the relative law adds between the two does not act on nodes that springs hold: it would take what pulls
  /// at them for what moves them.
  void keepForces(const Field3& force) noexcept;
  void restoreForces(Field3& force) const noexcept;
  /// The substep was accepted. links: null for Method::kPaper, which does not know its pulls; scale: of the multipliers
  /// [s^2].
  void count(const ClothState& state, const NodeForces& forces, const ExactSolver* links, const Contacts* contacts,
             double scale) noexcept;
  /// After a frame, of which this share was made. True: a hand has to let go.
  bool end(double share, const ClothState& state) noexcept;
  void letGoOfEnded(PinMoves& pins) noexcept;

  void carry(Archive& archive);
  /// Whether a hand pins a node; while carry() loads, as it will be.
  bool willPin(std::size_t node) const noexcept { return loaded_[node] == 2; }
  /// After carry() has loaded.
  void resume() noexcept { note(); }

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

    bool holds() const noexcept { return !held.empty(); }
    bool moves() const noexcept;
    Vec3 origin(double share) const noexcept { return from.position + share * (to.position - from.position); }
    void push(const Vec3& at, const Vec3& origin, const Vec3& given) noexcept {
      impulse += given;
      angular += (at - origin).cross(given);
    }
  };

  std::size_t indexOf(const std::string& id) const noexcept;
  void prepare(Grasp& grasp) const;
  void listNodes(const GraspParams& grasp, std::vector<std::size_t>& nodes, std::vector<Problem>& problems) const;
  bool isFree(std::size_t node) const noexcept { return scene_pins_[node] == kFree && hand_[node] < 0; }
  void note() noexcept;
  void release(Grasp& grasp, PinMoves& pins) noexcept;
  void countPinned(Grasp& grasp, const ClothState& state, const NodeForces& forces, const ExactSolver& links,
                   double scale) noexcept;
  void countContacts(const ClothState& state, const Contacts& contacts, double scale) noexcept;
  void countSprings(Grasp& grasp, const ClothState& state) noexcept;
  void slide(Grasp& grasp, const ClothState& state) noexcept;
  void changeHeld(Grasp& grasp, const ClothState& state) noexcept;
  void carryGrasp(Archive& archive, Grasp& grasp);

  const Scene& scene_;
  const ClothPattern& pattern_;
  const std::vector<std::uint8_t> scene_pins_;
  double total_mass_;  // [kg]
  std::vector<Grasp> list_;
  int holding_ = 0;
  std::vector<std::uint8_t> pinned_;  // by node
  std::vector<std::uint8_t> loaded_;  // by node, of what carry() loads: 2: pinned, 1: held by a spring
  std::vector<int> hand_;             // by node: index of the grasp that holds it, or -1
  FramePart part_;
};

}  // namespace curtain
