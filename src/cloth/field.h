// SPDX-License-Identifier: BSD-3-Clause
//
// Structure of arrays for the grid's nodes. A row's columns are adjacent, so sweeps along the warp run over whole rows
// at unit stride. Rows are padded to a multiple of kLane; padding has inverse mass 0.
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

/// Aligns the first element to a cache line (else every other wide load crosses a line), and spreads large fields over
/// the lines of a page: fields used together would otherwise share one set of the cache.
template <typename T>
struct CacheAligned {
  using value_type = T;
  CacheAligned() = default;
  template <typename U>
  CacheAligned(const CacheAligned<U>&) noexcept {}
  T* allocate(std::size_t count) {
    char* const block = static_cast<char*>(::operator new(count * sizeof(T) + (kLines + 2) * kLine));
    const auto address = reinterpret_cast<std::uintptr_t>(block);
    const std::size_t to_line = kLine - address % kLine;
    const std::size_t spread = (address / 4096U * 13U) % kLines;  // varies from page to page
    char* const first = block + to_line + spread * kLine;
    reinterpret_cast<char**>(first)[-1] = block;
    return reinterpret_cast<T*>(first);
  }
  void deallocate(T* pointer, std::size_t) noexcept { ::operator delete(reinterpret_cast<char**>(pointer)[-1]); }
  friend bool operator==(const CacheAligned&, const CacheAligned&) noexcept { return true; }
  friend bool operator!=(const CacheAligned&, const CacheAligned&) noexcept { return false; }

 private:
  static constexpr std::size_t kLine = 64;
  static constexpr std::size_t kLines = 61;
};

using Field = std::vector<double, CacheAligned<double>>;

/// Doubles in a cache line; rows are padded to a multiple of it.
constexpr int kLane = 8;

/// Added to a squared length, it avoids a division by a zero length, and changes no other value [m^2].
constexpr double kTinySquared = 1e-300;

/// Shape of the grid, and index of node (row, column) in a Field.
struct Grid {
  int rows = 0;
  int columns = 0;
  int stride = 0;  ///< distance between rows in a Field
  bool closed = false;
  int end_rows = 0;           ///< rows below the cloth's, of points that are no cloth: the ends of cords
  std::vector<int> slit_row;  ///< by column: first row whose weft link on the column's left is cut; empty: none is

  Grid() = default;
  Grid(int row_count, int column_count, bool is_closed)
      : rows(row_count), columns(column_count), stride(strideFor(column_count)), closed(is_closed) {}

  /// An odd number of cache lines, so that a column's successive rows fall into different sets of the cache.
  static int strideFor(int column_count) { return ((column_count + kLane - 1) / kLane | 1) * kLane; }

  std::size_t size() const { return row(allRows()); }
  /// With those of the ends.
  int allRows() const { return rows + end_rows; }
  /// Where the k-th end is in a Field.
  std::size_t end(std::size_t k) const {
    return row(rows) + k / static_cast<std::size_t>(columns) * static_cast<std::size_t>(stride) +
           k % static_cast<std::size_t>(columns);
  }
  std::size_t row(int i) const { return static_cast<std::size_t>(i) * static_cast<std::size_t>(stride); }
  std::size_t index(int i, int j) const { return row(i) + static_cast<std::size_t>(j); }
  std::size_t index(NodeIndex node) const { return index(node.row, node.column); }
  std::size_t nodeCount() const { return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns); }
  /// Weft links of a row, cut ones included.
  int linkCount() const { return closed ? columns : columns - 1; }
  /// Whether there is a weft link from the column on the left of `right` to it.
  bool hasLink(int row, int right) const {
    return (right > 0 || closed) && (slit_row.empty() || row < slit_row[static_cast<std::size_t>(right)]);
  }
  /// Whether there is cloth between rows `row` and row + 1 on the left of column `right`.
  bool hasQuad(int row, int right) const { return hasLink(row + 1, right); }
};

/// Three components of a vector field over the grid.
struct Field3 {
  Field x, y, z;

  void assign(std::size_t count, double value) {
    x.assign(count, value);
    y.assign(count, value);
    z.assign(count, value);
  }
  Vec3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, const Vec3& value) {
    x[i] = value.x();
    y[i] = value.y();
    z[i] = value.z();
  }
  void add(std::size_t i, const Vec3& value) {
    x[i] += value.x();
    y[i] += value.y();
    z[i] += value.z();
  }
};

/// The components of a field from an offset on, e.g. of a row, for loops over nodes.
struct FieldView {
  double *x, *y, *z;
  FieldView(Field3& field, std::size_t offset)
      : x(field.x.data() + offset), y(field.y.data() + offset), z(field.z.data() + offset) {}
};
struct ConstFieldView {
  const double *x, *y, *z;
  ConstFieldView(const Field3& field, std::size_t offset)
      : x(field.x.data() + offset), y(field.y.data() + offset), z(field.z.data() + offset) {}
};

}  // namespace curtain
