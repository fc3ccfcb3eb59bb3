// SPDX-License-Identifier: BSD-3-Clause
//
// Upper bound of the kinetic energy after a substep. Links do no work as seen from pins that move alike and steadily:
// the cloth has its old energy plus what forces put in over the mean of the velocities before and after. Along
// directions at the end of the step links can only shorten the velocities of free nodes, so there the forces' work is
// that without links. Past pins that move at u, sqrt(2 E) grows by 2 u sqrt(M) at most. Pins that draw a flat string
// taut put in more, against its tension; that is not bounded here.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "step/node_inertia.h"
#include "step/scheme.h"

namespace curtain {

/// Not thread-safe. Allocates only in the constructor. Energies are seen from the mean velocity of the pins.
class KineticGuard {
 public:
  /// stretch_tolerance: relative; links: a typical link's length [m]. pattern and inertia must outlive this.
  KineticGuard(const ClothPattern& pattern, const NodeInertia& inertia, double stretch_tolerance, double links);

  void takeStretchTolerance(double tolerance) noexcept { stretch_tolerance_ = tolerance; }
  /// The pattern's pins have changed.
  void takePins() noexcept;

  struct Finding {
    double most = std::numeric_limits<double>::infinity();  ///< twice the energy to bound it by [J]; infinite: no need
    double gain = 0.0;                                      ///< twice the excess energy [J]
    bool jumps = false;  ///< the links have jumped to another configuration: the substep has failed
  };
  /// Whether a substep of rods alone needs no look(): predicted_violation is the largest relative violation of a rod
  /// after the prediction with the last substep's multipliers.
  static bool isSmall(double predicted_violation) noexcept;
  /// Checks a solved substep. surface: largest speed that contacts drive points with [m/s]; 0: no contact, or at rest.
  /// drawn: twice what a guide's drive put in [J].
  Finding look(const Scheme::Rules& rules, const SubstepStart& start, const Field3& end, double surface,
               double drawn = 0.0) const noexcept;

  /// Twice the largest allowed kinetic energy of such a substep [J]: free nodes without links, and the pins' share.
  double most(const Scheme::Rules& rules, const SubstepStart& start, const Field3& end, double surface,
              double drawn = 0.0) const noexcept;
  /// The same for velocities [m/s] before their projection; surface: largest speed of what is touched [m/s].
  double most(const Field3& velocity, double surface) const noexcept;

  /// Scales the free nodes' velocities in the world down until the excess over that (twice an energy [J]) is gone.
  void bound(double most, Field3& velocity) const noexcept;

 private:
  struct Sums {
    double stepped = 0.0;  // twice the kinetic energy of the displacement made [J]
    double put_in = 0.0;   // the same without the links' work [J]
  };
  Sums sumsOf(const SubstepStart& start, const Field3& end, const Vec3& frame, bool backward) const noexcept;
  Vec3 frameOf(const Field3& velocity) const noexcept;
  double kineticOf(const Field3& velocity, const Vec3& frame) const noexcept;
  double drivenBy(const Field3& velocity, const Vec3& frame, double surface) const noexcept;
  double fromTolerance(double h) const noexcept;

  const ClothPattern& pattern_;
  const NodeInertia& inertia_;
  double stretch_tolerance_;
  const double links_;
  std::vector<std::size_t> pins_;  // with room for every node
};

}  // namespace curtain
