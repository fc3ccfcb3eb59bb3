// SPDX-License-Identifier: BSD-3-Clause
//
// The scheme of Cheng 2000, Sect. 3: explicit, one pass, nothing solved or iterated. Where the paper is ambiguous we
// read it so that rods neither stretch nor compress, as it promises (Sects. 1.2, 2.1, 3.2):
//
//   warp, Sect. 3.1   From the lowest node up: Eqs. (5) and (6) give the rod's tension with the node above fixed;
//                     Eqs. (7) and (8) then predict the node.
//   weft, Sect. 3.2   Fig. 8 on the prediction, row by row, once: neighbours too far apart are moved together.
//   contact, Sect. 4  On the prediction, once.
//   step (5)          "Back to world coordinates": from the top down x_i = x_(i-1) + l R(omega dt) n, where
//                     R(omega dt) n is the direction to the prediction: every rod turns and keeps its length.
//   velocities        Those of the new positions. What step (5) moves a node by is an impulse of its rod, which acts on
//                     the node above with opposite sign (Mueller et al. 2012, "Fast Simulation of Inextensible Hair and
//                     Fur", Sect. 3.3, with its factor s = 1): momentum is kept.
//
// First order. The weft comes before the rods, so what one pass leaves of its overlength stays and shows in
// Statistics::weft_stretch. The kinetic energy is bounded by the old one plus the work of the forces, at any step.
//
// The paper's columns hang from their top node. A column with pins elsewhere is rebuilt from them, up and down. Between
// two pins half of the rods are rebuilt from each; the rod in between is adjusted once, as in Fig. 8, and may change
// its length. A column without a pin is rebuilt from its topmost node and moved as a whole to where its centre of mass
// was predicted; its tensions are computed in its own accelerated frame.
//
// Contact moves nodes back that step (5) takes through something; rods at such a node change their length meanwhile.
#pragma once

#include <cstdint>
#include <vector>

#include "step/substep.h"

namespace curtain {

class PaperSolver {
 public:
  explicit PaperSolver(const ClothPattern& pattern);

  /// Updates what depends on the pattern's pins. Allocates.
  void pinsChanged();

  /// One substep of length h > 0 [s]; finder may be null. Where a force is beyond numbers the cloth stops where it is.
  SubstepOutcome substep(const NodeForces& forces, double h, ContactFinder* finder, ClothState& state,
                         StageClock& clock) noexcept;

 private:
  /// Nodes anchor + k step, k = 1 ... rods, each rebuilt from the one before.
  struct Chain {
    std::size_t anchor;
    std::ptrdiff_t step;
    int rods;
    bool loose;         ///< the anchor is not pinned and moves too
    double max_energy;  ///< [J]; scratch

    int first() const { return loose ? 0 : 1; }
    std::size_t node(int k) const { return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(anchor) + k * step); }
  };

  void addColumn(int column);
  Vec3 accelerationOf(const Chain& chain, const NodeForces& forces) const noexcept;
  void predict(const Chain& chain, const NodeForces& forces, double h, ClothState& state) const noexcept;
  void adjust(std::size_t a, std::size_t b, double excess, Field3& position) noexcept;
  void adjustRow(int row, Field3& position) noexcept;
  void adjustBetweenPins(Field3& position) noexcept;
  void project(double h, Contacts& contacts, Field3& position) const noexcept;
  void rebuild(const Chain& chain, double h, ClothState& state) const noexcept;
  bool holdBack(ContactFinder& finder, Contacts& contacts, double h, ClothState& state) noexcept;
  void stopApproach(const Contacts& contacts, Field3& velocity) const noexcept;
  void stop(ClothState& state) const noexcept;
  bool sound(const ClothState& state, double h) const noexcept;

  void addMean(const Chain& chain, const Field3& value, Vec3& sum, double& mass) const noexcept;
  Vec3 commonMean(const Field3& value) const noexcept;
  Vec3 carrierOf(const Chain& chain, const Field3& value, const Vec3& common) const noexcept;
  double kineticEnergy(const Chain& chain, const Field3& velocity, const Vec3& carrier) const noexcept;
  void keepEnergies(const Field3& velocity) noexcept;
  void boundEnergy(const NodeForces& forces, ClothState& state) noexcept;
  void slowDown(const Chain& chain, double most, double energy, const Vec3& carrier, Field3& velocity) const noexcept;

  std::size_t columnOf(std::size_t node) const { return node % static_cast<std::size_t>(pattern_.grid.stride); }
  bool isTaut(const Chain& chain) const { return taut_[columnOf(chain.anchor)] != 0; }
  double rodLength(const Chain& chain, int k) const {
    return pattern_.warp_rest[chain.node(chain.step > 0 ? k : k - 1)];
  }

  const ClothPattern& pattern_;
  double max_way_;  // of a node in a substep [m]
  std::vector<Chain> chains_;
  std::vector<std::size_t> pins_;
  std::vector<std::size_t> between_;  // lower node of the rod half way between two pins of a column
  std::vector<std::uint8_t> taut_;    // by column: a weft has pulled on it in this substep
  Field3 start_;
  Field3 rebuilt_;
};

}  // namespace curtain
