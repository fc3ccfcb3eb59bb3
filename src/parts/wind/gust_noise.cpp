// SPDX-License-Identifier: BSD-3-Clause
#include "parts/wind/gust_noise.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "cloth/wide.h"
#include "scene/splitmix.h"

namespace curtain {
namespace {

// Of the lattice points on both sides, at t in [0, 1] between them.
std::pair<double, double> weightsAt(double t) {
  const double fraction = t * t * (3.0 - 2.0 * t);  // smooth at both ends
  const double size = std::sqrt(fraction * fraction + (1.0 - fraction) * (1.0 - fraction));
  return {(1.0 - fraction) / size, fraction / size};
}

// Number of cells no longer than the correlation length. The slack is for rounding of the length, a sum of rods.
int latticeCells(double length, double correlation_length, int least, int most) {
  const double cells = std::ceil(length / correlation_length - 1e-9);
  return static_cast<int>(std::clamp(cells, static_cast<double>(least), static_cast<double>(most)));
}

}  // namespace

double hashedNormal(std::uint64_t seed, std::int64_t a, std::int64_t b, std::int64_t c) {
  std::uint64_t bits = splitmix(seed);
  bits = splitmix(bits ^ static_cast<std::uint64_t>(a));
  bits = splitmix(bits ^ static_cast<std::uint64_t>(b));
  bits = splitmix(bits ^ static_cast<std::uint64_t>(c));
  double sum = 0.0;
  for (int part = 0; part < 4; ++part) {
    sum += (static_cast<double>(bits & 0xffffU) + 0.5) / 65536.0;
    bits >>= 16U;
  }
  return (sum - 2.0) * std::sqrt(3.0);  // four uniform numbers have mean 2 and variance 4/12
}

GustNoise::Place GustNoise::place(double coordinate) {
  Place place;
  place.low = static_cast<int>(coordinate);
  place.high = place.low + 1;
  std::tie(place.low_weight, place.high_weight) = weightsAt(coordinate - place.low);
  return place;
}

GustNoise::GustNoise(std::uint64_t seed, double correlation_length, double correlation_time,
                     const ClothPattern& pattern)
    : seed_(seed), correlation_time_(correlation_time) {
  const Grid& grid = pattern.grid;
  const double height = pattern.warp_coordinate[grid.index(grid.rows - 1, 0)];
  const double width = pattern.weft_coordinate.back() + (grid.closed ? pattern.weft_rest[grid.index(0, 0)] : 0.0);
  const int row_cells = latticeCells(height, correlation_length, 1, grid.rows);
  // A single cell around a ring would have one lattice point for both its ends.
  const int column_cells = latticeCells(width, correlation_length, grid.closed ? 2 : 1, grid.columns);
  for (int i = 0; i < grid.rows; ++i)  // other cloths' rows as if they were as high
    row_place_.push_back(place(pattern.warp_coordinate[grid.index(i, 0)] / height * row_cells));
  for (const double u : pattern.weft_coordinate) column_place_.push_back(place(u / width * column_cells));
  if (grid.closed) {
    for (Place& p : column_place_) p.high %= column_cells;  // the lattice closes with the ring
  }
  lattice_columns_ = column_cells + 2;
  lattice_rows_.resize(static_cast<std::size_t>(row_cells + 2));
  const std::size_t points = lattice_rows_.size() * static_cast<std::size_t>(lattice_columns_);
  for (std::vector<Vec3>* const values : {&lattice_, &before_, &after_}) values->assign(points, Vec3::Zero());
}

void GustNoise::setTime(double time) noexcept {
  const double slab_time = time / correlation_time_;
  const double slab_floor = std::floor(slab_time);
  slab_ = static_cast<std::int64_t>(slab_floor);
  std::tie(before_weight_, after_weight_) = weightsAt(slab_time - slab_floor);
  for (LatticeRow& row : lattice_rows_) row.mixed = false;
}

// A row's random numbers last for a correlation time; only their interpolation changes meanwhile.
void GustNoise::prepareRow(int row) noexcept {
  LatticeRow& known = lattice_rows_[static_cast<std::size_t>(row)];
  if (known.mixed) return;
  const auto first = static_cast<std::size_t>(row) * static_cast<std::size_t>(lattice_columns_);
  const std::size_t end = first + static_cast<std::size_t>(lattice_columns_);
  for (std::size_t point = first; point < end && known.slab != slab_; ++point) {
    const auto where = static_cast<std::int64_t>(point);
    for (int axis = 0; axis < 3; ++axis) {
      before_[point][axis] = hashedNormal(seed_, where, axis, slab_);
      after_[point][axis] = hashedNormal(seed_, where, axis, slab_ + 1);
    }
  }
  for (std::size_t point = first; point < end; ++point) {
    lattice_[point] = before_weight_ * before_[point] + after_weight_ * after_[point];
  }
  known = {slab_, true};
}

Vec3 GustNoise::at(int row, int column) noexcept {
  const Place& v = row_place_[static_cast<std::size_t>(row)];
  const Place& u = column_place_[static_cast<std::size_t>(column)];
  prepareRow(v.low);
  prepareRow(v.high);
  const auto point = [&](int i, int j) -> const Vec3& {
    return lattice_[static_cast<std::size_t>(i * lattice_columns_ + j)];
  };
  return v.low_weight * (u.low_weight * point(v.low, u.low) + u.high_weight * point(v.low, u.high)) +
         v.high_weight * (u.low_weight * point(v.high, u.low) + u.high_weight * point(v.high, u.high));
}

CURTAIN_WIDE void GustNoise::rowOf(int row, int component, double* out) noexcept {
  const Place& v = row_place_[static_cast<std::size_t>(row)];
  prepareRow(v.low);
  prepareRow(v.high);
  const Vec3* const low = lattice_.data() + static_cast<std::ptrdiff_t>(v.low) * lattice_columns_;
  const Vec3* const high = lattice_.data() + static_cast<std::ptrdiff_t>(v.high) * lattice_columns_;
  std::size_t j = 0;
  const std::size_t columns = column_place_.size();
  while (j < columns) {
    // The columns of one cell of the lattice share its corners.
    const int left = column_place_[j].low, right = column_place_[j].high;
    const double at_left = v.low_weight * low[left][component] + v.high_weight * high[left][component];
    const double at_right = v.low_weight * low[right][component] + v.high_weight * high[right][component];
    for (; j < columns && column_place_[j].low == left; ++j) {
      out[j] = column_place_[j].low_weight * at_left + column_place_[j].high_weight * at_right;
    }
  }
}

}  // namespace curtain
