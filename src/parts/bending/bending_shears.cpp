// SPDX-License-Identifier: BSD-3-Clause
//
// What links transmit between the joints of a weft line.
#include <algorithm>
#include <cmath>

#include "cloth/wide.h"
#include "parts/bending/bending_lines.h"

namespace curtain {
namespace {

constexpr double kNoLength = 1e-300;  // [m^2]; of a link that has none, which has no direction either

constexpr double kSlackShare = 0.01;  // a link that is shorter by this share is slack

// How far a string holds its link: 1 at its length, 0 where it is slack. string: 1 / rest length.
CURTAIN_INTO_WIDE double holds(double string, double square) {
  const double share = 1.0 - (1.0 - string * std::sqrt(square)) / kSlackShare;
  return share < 0.0 ? 0.0 : share > 1.0 ? 1.0 : share;
}

// The part of a shear that presses its link together: q pulls the link's start along its way.
Vec3 pressOf(const Vec3& q, const Vec3& way, double string) {
  const double square = way.squaredNorm();
  return (holds(string, square) * std::max(q.dot(way), 0.0) / std::max(square, kNoLength)) * way;
}

// The same of the links on the left of columns 1 and more; it goes from the shears to `spared`.
CURTAIN_INTO_WIDE void spareRow(const double* string, const ConstFieldView& x, const FieldView& q,
                                const FieldView& spared, std::size_t columns) {
#pragma omp simd
  for (std::size_t j = 1; j < columns; ++j) {
    const double wx = x.x[j] - x.x[j - 1], wy = x.y[j] - x.y[j - 1], wz = x.z[j] - x.z[j - 1];
    const double square = wx * wx + wy * wy + wz * wz, along = q.x[j] * wx + q.y[j] * wy + q.z[j] * wz;
    const double press =
        holds(string[j], square) * (along > 0.0 ? along : 0.0) / (square > kNoLength ? square : kNoLength);
    spared.x[j] = press * wx;
    spared.y[j] = press * wy;
    spared.z[j] = press * wz;
    q.x[j] -= spared.x[j];
    q.y[j] -= spared.y[j];
    q.z[j] -= spared.z[j];
  }
}

CURTAIN_INTO_WIDE void addRow(const double* q, std::size_t columns, bool closed, double* sum) {
#pragma omp simd
  for (std::size_t j = 0; j < columns - 1; ++j) sum[j] -= q[j] - q[j + 1];
  sum[columns - 1] -= closed ? q[columns - 1] - q[0] : q[columns - 1];
}

}  // namespace

CURTAIN_WIDE void addShears(const Grid& grid, const Field& string, const Field3& position, int block, Field3& q,
                            Field3* spared, Field3& sum) noexcept {
  const auto columns = static_cast<std::size_t>(grid.columns);
  for (int i = block * kLane; i < std::min((block + 1) * kLane, grid.rows); ++i) {
    const std::size_t first = grid.row(i);
    if (spared != nullptr) {
      spareRow(string.data() + first, ConstFieldView(position, first), FieldView(q, first), FieldView(*spared, first),
               columns);
      const Vec3 seam = position.at(first) - position.at(first + columns - 1);
      spared->set(first, grid.closed ? pressOf(q.at(first), seam, string[first]) : Vec3::Zero());
      q.set(first, q.at(first) - spared->at(first));
    }
    addRow(q.x.data() + first, columns, grid.closed, sum.x.data() + first);
    addRow(q.y.data() + first, columns, grid.closed, sum.y.data() + first);
    addRow(q.z.data() + first, columns, grid.closed, sum.z.data() + first);
  }
}

double workOfSpared(const Grid& grid, const Field3& spared, const Field3& position) noexcept {
  double work = 0.0;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = grid.closed ? 0 : 1; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j), start = grid.index(i, j > 0 ? j - 1 : grid.columns - 1);
      work += spared.at(n).dot(position.at(n) - position.at(start));
    }
  }
  return work;
}

Vec3 weftBendingAt(const Grid& grid, const BendingLines& lines, const Field3& position, int row, int column) noexcept {
  const auto at = [&](int j) { return grid.index(row, (j + grid.columns) % grid.columns); };
  const auto way = [&](int j) { return Vec3(position.at(at(j)) - position.at(at(j - 1))); };
  const auto moment = [&](int j) {
    const double a = lines.per_rest[at(j)], b = lines.per_rest[at(j + 1)];
    return Vec3(lines.stiffness[at(j)] * (b * way(j + 1) - a * way(j)));
  };
  const auto shear = [&](int j) {  // of the link on the left of column j
    const Vec3 q = lines.per_rest[at(j)] * (moment(j - 1) - moment(j));
    return Vec3(q - pressOf(q, way(j), lines.string[at(j)]));
  };
  return shear(column + 1) - shear(column);
}

}  // namespace curtain
