// SPDX-License-Identifier: BSD-3-Clause
//
// What the warp and weft solvers share: the links' directions and multipliers.
//
// A link between nodes a (above / left) and b (below / right) with direction d = x_b - x_a (not normalised, taken at
// some instant) and multiplier s moves its nodes by
//     x_a += w_a s d,   x_b -= w_b s d,
// so s > 0 is tension. Over a substep of length h whose forces act for a time `kick`, the tension is
// s |d| / (h kick) [N]. Every link is stored at its node b. A row of zeros after the last one spares the sweeps along
// the warp a test for the end of the column.
#pragma once

#include <limits>

#include "cloth/cloth.h"
#include "step/guided_nodes.h"

namespace curtain {

struct LinkSet {
  Field3 direction;                                           ///< [m], shape [(rows + 1) * stride]
  Field multiplier;                                           ///< [kg], shape [(rows + 1) * stride]
  double compliance = 0.0;                                    ///< relative overlength by a small multiplier [1/kg]
  double max_give = std::numeric_limits<double>::infinity();  ///< what the relative overlength by compliance tends to

  void assign(const Grid& grid) {
    const std::size_t size = grid.size() + static_cast<std::size_t>(grid.stride);
    direction.assign(size, 0.0);
    multiplier.assign(size, 0.0);
  }
};

/// What a line solver works on: nodal values (positions or velocities) moved along the links' directions.
struct LineSolve {
  const ClothPattern& pattern;
  const Field& inverse_inertia;  ///< of the nodes in this substep [1/kg]
  LinkSet& links;
  Field3& value;                  ///< positions [m], or velocities [m/s]
  GuidedNodes* guided = nullptr;  ///< null: all nodes are free or pinned
};

/// Scratch of a line solver.
struct LineScratch {
  Field elimination;
  Field solution;
  void assign(const Grid& grid) {
    const std::size_t size = grid.size() + static_cast<std::size_t>(grid.stride);
    elimination.assign(size, 0.0);
    solution.assign(size, 0.0);
  }
};

/// Outcome of one Newton iteration over lines.
struct LineOutcome {
  double residual = 0.0;  ///< largest relative violation before the iteration; velocities: [1/s]
  bool sound = true;      ///< false: a pivot vanished, since some link turned too far from its direction
};

}  // namespace curtain
