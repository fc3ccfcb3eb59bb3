// SPDX-License-Identifier: BSD-3-Clause
//
// What the rivals share: nodes as a structure of arrays, links as batches of independent ones.
//
// A row is stored as its even columns, then its odd ones, so that a batch touches no node twice and runs along memory:
//
//   row i   | 0 2 4 … | 1 3 5 … |
//   warp         all columns, row i-1 to i               rods, top first: what a pin holds reaches the hem in one sweep
//   weft even    (0,1) (2,3) …   odd   (1,2) (3,4) …     strings
#pragma once

#include <cstddef>
#include <vector>

#include "bench/contestant.h"

namespace curtain_bench {

/// Links a+k to b+k for k < count, no node twice.
struct LinkBatch {
  std::size_t a = 0;
  std::size_t b = 0;
  std::size_t count = 0;
  std::size_t first = 0;  ///< number of the first link, for arrays with an entry a link
  double rest = 0.0;      ///< [m]
  bool two_sided = false;
};

/// Three coordinates of every node, in the layout above.
struct Triple {
  std::vector<double> x, y, z;

  void assign(std::size_t count, double value) {
    x.assign(count, value);
    y.assign(count, value);
    z.assign(count, value);
  }
};

class GridState {
 public:
  explicit GridState(const ClothStart& start);

  std::size_t count() const { return inverse_mass.size(); }
  void copyOut(const Triple& from, Points& out) const;

  Triple position;                   ///< [m]
  Triple velocity;                   ///< [m/s]
  std::vector<double> mass;          ///< [kg]
  std::vector<double> inverse_mass;  ///< [1/kg], 0 = pinned
  std::vector<double> free;          ///< 1, pinned 0
  std::vector<LinkBatch> batches;    ///< warp from the top, then weft
  std::size_t link_count = 0;
  double min_free_mass = 0.0;   ///< [kg]
  std::vector<double> gravity;  ///< [m/s^2], three entries
  double damping = 0.0;         ///< [1/s]
  double frame_seconds = 0.0;

 private:
  std::size_t index(int row, int column) const;

  int rows_ = 0;
  int columns_ = 0;
};

/// Energy of springs of one stiffness [N/m] [J].
double springEnergy(const GridState& state, double stiffness);

}  // namespace curtain_bench
