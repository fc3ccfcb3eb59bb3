// SPDX-License-Identifier: BSD-3-Clause
//
// A part whose nodes do not move freely, and what the solver asks of it. The solver tells it when nodes were moved as
// if they were free, and what acts on them; the part puts them where they may be. What else acts on them is its own:
// friction, a drive, what they do to each other.
#pragma once

#include "step/guided_nodes.h"
#include "step/warp_solver.h"

namespace curtain {

/// What links and all else act with on a node now [N].
class NodeForce {
 public:
  virtual Vec3 at(int row, int column) const noexcept = 0;

 protected:
  ~NodeForce() = default;
};

/// Not thread-safe, but for settlePositions() and settleVelocities(). Allocates only in its constructor.
class GuidePart : public GuidedNodes {
 public:
  // ---- A substep

  /// Begins a substep from `start`, which is at `state` or a scheme's own. inverse: of the nodes in this substep
  /// [1/kg]; 0 of one of its own: they stand still.
  virtual void begin(const SubstepStart& start, const ClothState& state, const Field& inverse) noexcept = 0;
  /// In this substep they may move.
  virtual bool moves() const noexcept = 0;
  /// Reads the forces that act on its nodes now.
  virtual void press(const NodeForce& force) noexcept = 0;
  /// After loops over all nodes: all of its nodes together. True: a freedom has changed.
  virtual bool settle(Field3& position) noexcept = 0;
  /// The links' directions are those of the present positions from now on.
  virtual void followDirections() noexcept = 0;
  /// Accepts the substep: sets what of the state is its own, and its nodes' velocities.
  virtual void commit(ClothState& state) noexcept = 0;
  /// Twice the energy that it has put in, in the substep being made [J].
  virtual double energy() const noexcept = 0;
  /// Its work in the last substep, whose forces acted for `kick` [s] and took the velocities from `before` to `after`
  /// [J].
  virtual double work(const Field3& before, const Field3& after, double kick) const noexcept = 0;

  // ---- Velocities at the places of the last accepted substep

  /// Velocities [m/s] that forces have changed for `age` [s]: as its nodes may have them.
  virtual void beginRates(const ClothState& state, double age, Field3& velocity) noexcept = 0;
  /// All of its nodes together.
  virtual void settleRates(Field3& velocity) noexcept = 0;

  // ---- What a substep leaves to the next

  virtual void save(std::vector<double>& memory) const = 0;
  virtual void restore(const std::vector<double>& memory) noexcept = 0;
  virtual void forget() noexcept = 0;

 protected:
  using GuidedNodes::GuidedNodes;
};

}  // namespace curtain
