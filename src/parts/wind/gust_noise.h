// SPDX-License-Identifier: BSD-3-Clause
//
// Gusts, the unsteadiness of Cheng 2000, end of Sect. 2.2.2: a random vector field over the cloth and time, of unit
// variance in each component, with given correlation length and time. It depends on seed, place and time only: step and
// grid do not change its statistics, and a seed repeats a run to the bit.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "cloth/cloth.h"

namespace curtain {

class GustNoise {
 public:
  /// seed                any
  /// correlation_length  [m] along the cloth, > 0 (not resolved below the grid's own spacing)
  /// correlation_time    [s], > 0
  GustNoise(std::uint64_t seed, double correlation_length, double correlation_time, const ClothPattern& pattern);

  /// Sets the time of the field [s], before it is read. Random numbers are made only for rows that are read. Allocates
  /// nothing.
  void setTime(double time) noexcept;

  /// The field at a node at the time set.
  Vec3 at(int row, int column) noexcept;

  /// The field along a row: one component (0..2) of all columns into out, shape [columns].
  void rowOf(int row, int component, double* out) noexcept;

 private:
  // Interpolation between two lattice points; weights with unit sum of squares keep the variance at one everywhere.
  struct Place {
    int low = 0;
    int high = 0;
    double low_weight = 1.0;
    double high_weight = 0.0;
  };
  static Place place(double coordinate);

  struct LatticeRow {
    std::int64_t slab = std::numeric_limits<std::int64_t>::min();  // of before_ and after_
    bool mixed = false;                                            // lattice_ is of the time set
  };
  void prepareRow(int row) noexcept;

  std::uint64_t seed_;
  double correlation_time_;
  int lattice_columns_ = 0;
  std::vector<Place> row_place_;
  std::vector<Place> column_place_;
  std::int64_t slab_ = 0;  // number of correlation times before the time set
  double before_weight_ = 1.0, after_weight_ = 0.0;
  std::vector<LatticeRow> lattice_rows_;
  std::vector<Vec3> before_, after_;  // at the lattice points, at both slabs
  std::vector<Vec3> lattice_;         // the field there at the time set
};

/// A number of unit variance and zero mean from a seed and three integers: sum of four uniform 16-bit numbers.
double hashedNormal(std::uint64_t seed, std::int64_t a, std::int64_t b, std::int64_t c);

}  // namespace curtain
