// SPDX-License-Identifier: BSD-3-Clause
//
// The account of energy: what forces, pins, drives and obstacles put in, what links and contacts take, and so what the
// cloth may have after a substep and after a frame.
//
// A substep takes the velocities from v to v' by impulses; an impulse p at a node adds p . (v + v') / 2 to its kinetic
// energy, exactly. So a force's work is its impulse times the mean velocity. Leapfrog's velocities are half a substep
// apart from its positions: weight acts at the positions, so its work is the change of potential half way between them.
//
// Links do no work as seen from pins that move alike and steadily: the cloth has its old energy plus what was put in.
// Along directions at the end of the step links can only shorten the velocities of free nodes, so there the forces'
// work is that without links. Past pins that move at u, sqrt(2 E) grows by 2 u sqrt(M) at most. Pins that draw a flat
// string taut put in more, against its tension; that is not bounded here.
//
// Links and contacts need not hold exactly. One that pulls with T while it gives way by e takes T e, and gives it back
// when it is corrected: what they take is held until then, as far as the tolerance lets them hold it. What they give
// beyond that is made from nothing.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "curtain_sim/statistics.h"
#include "step/contacts.h"
#include "step/node_inertia.h"
#include "step/scheme.h"

namespace curtain {

class Archive;

/// Not thread-safe. Allocates only in the constructor.
class EnergyAccount {
 public:
  /// stretch_tolerance: relative; links: a typical link's length [m]. pattern and inertia must outlive this.
  EnergyAccount(const ClothPattern& pattern, const NodeInertia& inertia, double stretch_tolerance, double links);

  void setStretchTolerance(double tolerance) noexcept { stretch_tolerance_ = tolerance; }
  /// The pattern's pins have changed.
  void pinsChanged() noexcept;

  // ---- A substep. Energies are twice an energy [J], seen from the mean velocity of the pins

  /// What puts energy in beside forces and pins.
  struct Drive {
    double moving = 0.0;  ///< fastest that obstacles and parts move points [m/s]
    double pushed = 0.0;  ///< of obstacles alone, or of points that come out of what they are in [m/s]
    double put_in = 0.0;  ///< twice what guides did, and rows that give or whose length a part drives [J]
  };
  struct Entry {
    double most = std::numeric_limits<double>::infinity();  ///< to bound the velocities by; infinite: no need
    double held = 0.0;                                      ///< by links and contacts after the substep
    double made = 0.0;                                      ///< from nothing
  };
  /// Whether a substep of rods alone needs no entry: predicted_violation is the largest relative violation of a rod
  /// after the prediction with the last substep's multipliers.
  static bool isSmall(double predicted_violation) noexcept;
  /// Of a solved substep. can_hold: what links and contacts can hold by their tolerance.
  Entry entryOf(const Scheme::Rules& rules, const SubstepStart& start, const Field3& end, const Drive& drive,
                double can_hold) const noexcept;
  /// What links that are off by the tolerance at both ends of a substep of h [s] turn into speed: the more, the shorter
  /// it is.
  double fromTolerance(double h) const noexcept;
  /// The largest allowed kinetic energy of a substep: free nodes without links, and the pins' share.
  double most(const Scheme::Rules& rules, const SubstepStart& start, const Field3& end,
              const Drive& drive) const noexcept;
  /// The same for velocities [m/s] before their projection; surface: largest speed of what is touched [m/s].
  double most(const Field3& velocity, double surface) const noexcept;
  /// The free nodes' velocities have more.
  bool exceeds(double most, const Field3& velocity) const noexcept {
    return !(kineticOf(velocity, frameOf(velocity)) <= most);
  }
  /// Scales the free nodes' velocities in the world down until the excess over that is gone.
  void bound(double most, Field3& velocity) const noexcept;

  /// What links and contacts hold.
  double held() const noexcept { return held_; }
  void setHeld(double held) noexcept { held_ = held; }

  // ---- The books, for those who want them (energy_books.cpp)

  /// Before a substep from this state.
  void open(const ClothState& state) noexcept { before_ = state.velocity; }
  /// Velocities of then [m/s].
  const Field3& before() const noexcept { return before_; }
  /// After it: what the forces did, which acted for `kick` [s]; with_elastic: those and the elastic ones, or null.
  void bookForces(const Field3& velocity, const NodeForces& forces, const Field3* with_elastic, double kick) noexcept;
  /// What moving obstacles did, and moved pins that touch something; per_h: impulse over multiplier [1/s].
  void bookContacts(const Contacts& contacts, const Field3& velocity, double per_h) noexcept;
  /// What a moved pin did, by the impulse on it of links or contacts [N s].
  void bookPin(const Vec3& impulse, const Vec3& velocity) noexcept { work_.pins -= impulse.dot(velocity); }
  void bookDissipated(double work) noexcept { work_.dissipated += work; }
  void bookElastic(double work) noexcept { work_.elastic += work; }
  void bookDrive(double work) noexcept { work_.drive += work; }

  const Work& work() const noexcept { return work_; }
  /// For substeps that are repeated.
  void restore(const Work& work) noexcept { work_ = work; }

  // ---- Frames in which nothing puts energy in

  /// Something has put some in.
  void leaveOpen() noexcept { at_start_.reset(); }
  bool isClosed() const noexcept { return at_start_.has_value(); }
  /// At the end of such a frame: how far this energy is above that at the start of the first of them [J]; 0 for the
  /// first.
  double excess(double energy) noexcept;
  /// Takes the excess over the start out of the velocities, where that can be done.
  void removeExcess(const Energy& now, Field3& velocity) const noexcept;

  void serialize(Archive& archive);

 private:
  struct Sums {
    double stepped = 0.0;  // twice the kinetic energy of the displacement made [J]
    double put_in = 0.0;   // the same without the links' work [J]
  };
  Sums sumsOf(const SubstepStart& start, const Field3& end, const Vec3& frame, bool backward) const noexcept;
  Vec3 frameOf(const Field3& velocity) const noexcept;
  double kineticOf(const Field3& velocity, const Vec3& frame) const noexcept;
  double fastest(const Field3& velocity, const Vec3& frame, double surface) const noexcept;
  double drivenBy(const Field3& velocity, const Vec3& frame, double surface) const noexcept {
    return free_mass_ * fastest(velocity, frame, surface);
  }

  const ClothPattern& pattern_;
  const NodeInertia& inertia_;
  double stretch_tolerance_;
  const double links_;
  std::vector<std::size_t> pins_, held_nodes_;  // the latter: no link moves them; both with room for every node
  double free_mass_ = 0.0;                      // of the others [kg]
  double held_ = 0.0;
  Field3 before_;
  Work work_;
  std::optional<double> at_start_;  // energy of the first closed frame [J]; none: not closed
};

}  // namespace curtain
