// SPDX-License-Identifier: BSD-3-Clause
//
// What acts on the cloth beside links and contact, and what the simulator asks of it. A part overrides what concerns
// it; the rest does nothing. What the solver asks of a part: elastic_part.h, guide_part.h, row_part.h.
#pragma once

#include <vector>

#include "curtain_sim/plan.h"
#include "curtain_sim/statistics.h"
#include "step/substep.h"

namespace curtain {

class Archive;
class Step;

/// The forces of a substep, which parts add up in their order.
struct ForceSum {
  explicit ForceSum(Field& damping_) : damping(damping_) {}

  double time = 0.0;       ///< at its start [s]
  double done = 0.0;       ///< of the frame before it [s]
  double h = 0.0;          ///< its length [s]
  SubstepAhead ahead;      ///< where reads_air
  bool acts = false;       ///< a part has a force
  bool damps = false;      ///< a part has damping
  bool reads_air = false;  ///< a part reads the air's velocity, and the other forces: what moves air adds no force
  std::vector<std::size_t> led;  ///< nodes that a part leads: other forces on them say nothing of their motion
  Field3 force;                  ///< [N]
  Field& damping;                ///< [kg/s]
  Field3 air;                    ///< its velocity at the nodes [m/s], where reads_air
};

struct FrameBegin {
  double from = 0.0, to = 0.0;  ///< [s]
  double rate = 0.0;            ///< frames a second [1/s]
  bool links_hold = true;       ///< links are near their lengths
};

struct FrameEnd {
  double share = 1.0;   ///< of the frame that was made
  double length = 0.0;  ///< of a whole one [s]
  bool arrived = true;  ///< all of it was made, and no pin had to wait
  Statistics& statistics;
};

/// A substep that was accepted.
struct SubstepMade {
  double h = 0.0;           ///< [s]
  const ClothState& state;  ///< after it
  const NodeForces& forces;
  const Step* links;                   ///< null: the method does not know its pulls
  const Contacts* contacts = nullptr;  ///< null: none pushed
  double scale = 0.0;                  ///< of the multipliers [s^2]
};

/// Not thread-safe. Allocates in its constructor and in changes by the user.
class Part {
 public:
  virtual ~Part() = default;

  // ---- Its state
  /// Back to the scene's start, where `state` is.
  virtual void reset(ClothState& /*state*/) {}
  /// The user has moved the nodes from `before`: puts what of the state is its own where it may be.
  virtual void placed(const ClothState& /*before*/, ClothState& /*state*/) noexcept {}
  virtual void serialize(Archive& /*archive*/) {}
  /// After serialize() has loaded, or a key of the scene has changed: updates what depends on them.
  virtual void resume() {}
  /// Marks the nodes that it pins, or holds: kPinned, kHeld.
  virtual void pin(std::vector<std::uint8_t>& /*pinned*/) const noexcept {}
  virtual void measure(const ClothState& /*state*/, Statistics& /*statistics*/) const noexcept {}
  /// What it does now, or why it does nothing. True: it has forces.
  virtual bool explain(const ClothState& /*state*/, double /*time*/, Plan& /*plan*/) const { return false; }

  // ---- Between frames
  /// Something of it that reaches the cloth begins, ends or moves in the coming frame: sleeping cloth wakes.
  virtual bool wakes(const FrameBegin& /*begin*/, const ClothState& /*state*/) const noexcept { return false; }
  /// It never lets the cloth come to rest.
  virtual bool keepsAwake(const ClothState& /*state*/, double /*time*/) const noexcept { return false; }
  /// It moves the cloth until it is where it is to be: till then the cloth does not fall asleep.
  virtual bool isUnderWay(const ClothState& /*state*/) const noexcept { return false; }
  /// It may put in energy, by other means than forces.
  virtual bool drives(const ClothState& /*state*/) const noexcept { return false; }
  /// It may pull links longer than they are.
  virtual bool strains() const noexcept { return false; }
  /// Substeps with it can be made backwards in time.
  virtual bool reversible() const noexcept { return true; }
  /// Largest damping of a node at rest, over its mass [1/s]. air_speed: of what the parts before it blow with [m/s]; a
  /// part that blows adds its own.
  virtual double dampingPerMass(double& /*air_speed*/) const noexcept { return 0.0; }

  /// Before the coming frame it pins or frees nodes by its own schedule: begun() follows.
  virtual bool begins(const FrameBegin& /*begin*/) const noexcept { return false; }
  virtual void begun(const FrameBegin& /*begin*/, ClothState& /*state*/) noexcept {}

  // ---- A frame in which the cloth moves
  /// Before all else of it. True: a velocity has changed.
  virtual bool prepareFrame(const FrameBegin& /*begin*/, ClothState& /*state*/) noexcept { return false; }
  /// Before its substeps, after trial runs of it: sets the velocities that it prescribes. True: it pins other nodes
  /// from now on.
  virtual bool beginFrame(const FrameBegin& /*begin*/, ClothState& /*state*/) noexcept { return false; }
  /// Before a substep from this state: says whether it acts, damps, reads the air, and what it leads.
  virtual void announce(const ClothState& /*state*/, ForceSum& /*sum*/) noexcept {}
  /// After all have: adds its forces and its damping.
  virtual void addForces(const ClothState& /*state*/, ForceSum& /*sum*/) noexcept {}
  virtual void substepDone(const SubstepMade& /*made*/) noexcept {}
  /// True: it pins other nodes from now on.
  virtual bool endFrame(const FrameEnd& /*end*/, ClothState& /*state*/) noexcept { return false; }
};

/// In the order in which they are asked; they outlive it.
struct PartList : std::vector<Part*> {
  using std::vector<Part*>::vector;
  template <typename Asks>
  bool any(const Asks& asks) const {
    for (const Part* const part : *this) {
      if (asks(*part)) return true;
    }
    return false;
  }
};

}  // namespace curtain
