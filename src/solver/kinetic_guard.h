// SPDX-License-Identifier: BSD-3-Clause
//
// What a substep may have of kinetic energy. Links that hold do no work, seen from pins that all move alike and
// steadily: the cloth has what it had and what forces put in over the mean of its velocities before and after. Along
// directions at the end links can only shorten what the velocities would be without them, so there forces put in what
// they would then. Past pins that go by at u its sqrt of twice the kinetic energy grows by 2 u sqrt(M) at most. Pins
// that draw a flat string taut put in more, against what it bears; that is left out.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "solver/node_inertia.h"
#include "solver/scheme.h"

namespace curtain {

/// Not thread-safe. Allocates nothing after construction. Energies are those seen from the mean velocity of the pins.
class KineticGuard {
 public:
  /// stretch_tolerance  relative; links  [m], for scale. pattern and inertia must outlive this.
  KineticGuard(const ClothPattern& pattern, const NodeInertia& inertia, double stretch_tolerance, double links);

  struct Finding {
    double most = std::numeric_limits<double>::infinity();  ///< finite: it gains more than by the scheme's own error;
                                                            ///< to be bounded by this
    double gain = 0.0;                                      ///< twice the energy that it has found [J]
    bool jumps = false;  ///< nodes lie in another way than before: the substep has failed
  };
  /// Whether a substep of rods alone needs no look: surprise is the most that its prediction, with the last substep's
  /// multipliers, lacked of a rod's length, relative.
  static bool foreseen(double surprise) noexcept;
  /// Of a substep that was solved, from start to end. surface: the fastest that contacts drive points [m/s]; 0: nothing
  /// touches, or it is at rest.
  Finding look(const Scheme::Rules& rules, const SubstepStart& start, const Field3& end, double surface) const noexcept;

  /// Twice the largest kinetic energy of such a substep [J]: of free nodes without links, and what pins put in.
  double most(const Scheme::Rules& rules, const SubstepStart& start, const Field3& end, double surface) const noexcept;
  /// The same of velocities that links are to act on [m/s]; surface: the fastest of what is touched [m/s].
  double most(const Field3& velocity, double surface) const noexcept;

  /// Takes what is above twice that energy [J] out of the energy that the free nodes have in the world: slows them
  /// down, all alike and to rest, so nothing is put in by that.
  void bound(double most, Field3& velocity) const noexcept;

 private:
  struct Sums {
    double stepped = 0.0,
           put_in =
               0.0;  // twice the kinetic energies of the path that nodes have gone, and without links' work on it [J]
  };
  Sums sumsOf(const SubstepStart& start, const Field3& end, const Vec3& frame, bool backward) const noexcept;
  Vec3 frameOf(const Field3& velocity) const noexcept;
  double kineticOf(const Field3& velocity, const Vec3& frame) const noexcept;
  double drivenBy(const Field3& velocity, const Vec3& frame, double surface) const noexcept;
  double fromTolerance(double h) const noexcept;

  const ClothPattern& pattern_;
  const NodeInertia& inertia_;
  const double stretch_tolerance_, links_;
  const std::vector<std::size_t> pins_;
};

}  // namespace curtain
