// SPDX-License-Identifier: BSD-3-Clause
//
// Structure of arrays for the grid's nodes: the columns of a row lie side by side, so that every sweep along the
// warp runs over whole rows at unit stride. Rows are padded to a multiple of kLane; padding has inverse mass 0.
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

/// Puts the first element at the start of a cache line (else every other wide load crosses into the next one), and not
/// of the same line of a page for every large field: what lies side by side in a sweep would share one set of the
/// cache.
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
    const std::size_t spread = (address / 4096U * 13U) % kLines;  // pages differ, and so do the lines
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

/// Doubles a row is padded to: one cache line.
constexpr int kLane = 8;

/// Shape of the grid and where node (row, column) lies in a Field.
struct Grid {
  int rows = 0;
  int columns = 0;
  int stride = 0;  ///< distance between rows in a Field
  bool closed = false;

  Grid() = default;
  Grid(int row_count, int column_count, bool is_closed)
      : rows(row_count), columns(column_count), stride(strideFor(column_count)), closed(is_closed) {}

  /// An odd number of cache lines: the same column of successive rows falls into different sets of the cache.
  static int strideFor(int column_count) { return ((column_count + kLane - 1) / kLane | 1) * kLane; }

  std::size_t size() const { return static_cast<std::size_t>(rows) * static_cast<std::size_t>(stride); }
  std::size_t row(int i) const { return static_cast<std::size_t>(i) * static_cast<std::size_t>(stride); }
  std::size_t index(int i, int j) const { return row(i) + static_cast<std::size_t>(j); }
  std::size_t index(NodeIndex node) const { return index(node.row, node.column); }
  std::size_t nodeCount() const { return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns); }
  /// Weft links of a row; link j joins the columns weftFirst(j) and j.
  int linkCount() const { return closed ? columns : columns - 1; }
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

}  // namespace curtain
