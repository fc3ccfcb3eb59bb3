// SPDX-License-Identifier: BSD-3-Clause
//
// Unsteadiness of the air (Cheng 2000, end of Sect. 2.2.2): a random vector field over the cloth and time, of unit
// variance in each component, with a correlation length and time of its own. It is a function of seed, place and
// time alone: neither the step nor the grid changes its statistics, and a seed repeats a run to the bit.
#pragma once

#include <cstdint>
#include <vector>

#include "cloth/cloth.h"

namespace curtain {

class GustNoise {
 public:
  /// seed                any
  /// correlation_length  [m] along the cloth, > 0 (not resolved below the grid's own spacing)
  /// correlation_time    [s], > 0
  GustNoise(std::uint64_t seed, double correlation_length, double correlation_time, const ClothPattern& pattern);

  /// Sets the time of the field [s]. Allocates nothing.
  void setTime(double time) noexcept;

  /// The field at a node at the time set.
  Vec3 at(int row, int column) const noexcept;

  /// The field along a row: one component (0..2) of all columns into out, shape [columns].
  void rowOf(int row, int component, double* out) const noexcept;

 private:
  // A place between two lattice points; weights of unit sum of squares keep the variance at one everywhere.
  struct Place {
    int low = 0;
    int high = 0;
    double low_weight = 1.0;
    double high_weight = 0.0;
  };
  static Place place(double coordinate);

  std::uint64_t seed_;
  double correlation_time_;
  int lattice_columns_ = 0;
  std::vector<Place> row_place_;
  std::vector<Place> column_place_;
  std::vector<Vec3> lattice_;  // the field at the lattice points at the time set
};

/// A number of unit variance and zero mean from a seed and three integers: sum of four uniform 16-bit numbers.
double hashedNormal(std::uint64_t seed, std::int64_t a, std::int64_t b, std::int64_t c);

}  // namespace curtain
