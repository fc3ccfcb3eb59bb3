// SPDX-License-Identifier: BSD-3-Clause
#include "parts/wind/layer_shadow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace curtain {
namespace {

constexpr int kCells = 64;  // along either direction, at most; what is found does not depend on it

constexpr double kEdge = 1e-9;       // of a triangle's weights, and of a line: on an edge, it is met by both sides
constexpr std::size_t kSheets = 16;  // that a line is followed through, one after the other

// Where along the line from one point to another it crosses the triangle, [0..1]; negative: nowhere (Möller, Trumbore
// 1997).
double crossing(const Vec3& from, const Vec3& to, const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  const Vec3 line = to - from, ab = b - a, ac = c - a, across = line.cross(ac);
  const double volume = ab.dot(across);
  if (volume == 0.0) return -1.0;
  const Vec3 off = from - a, turned = off.cross(ab);
  const double u = off.dot(across) / volume, v = line.dot(turned) / volume, along = ac.dot(turned) / volume;
  return u >= -kEdge && v >= -kEdge && u + v <= 1.0 + kEdge && along >= 0.0 && along <= 1.0 ? along : -1.0;
}

}  // namespace

LayerShadow::LayerShadow(const ClothPattern& pattern) : pattern_(pattern) {
  if (pattern.layer.back() == 0) return;
  const auto stride = static_cast<std::size_t>(pattern.grid.stride);
  for (const MeshTriangle& triangle : makeCoarseMesh(pattern.grid).triangles)
    triangles_.push_back({{triangle[0], triangle[1], triangle[2]}, pattern.layer[triangle[0] % stride]});
  places_.resize(pattern.grid.size());
  lows_.resize(triangles_.size());
  sorted_.resize(triangles_.size());
  begins_.resize(kCells * kCells + 1);
}

LayerShadow::Place LayerShadow::placeOf(const Vec3& point, const WindSource& wind) const noexcept {
  const Vec3 from = wind.origin(point) - wind.params().position;
  return {from.dot(wind.across(0)), from.dot(wind.across(1))};
}

int LayerShadow::cellAlong(double place, double from) const noexcept {
  return static_cast<int>(std::clamp((place - from) / size_, 0.0, kCells - 1.0));
}

void LayerShadow::sortIntoCells(const Field3& position, const WindSource& wind) noexcept {
  const Grid& grid = pattern_.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      places_[n] = placeOf(position.at(n), wind);
    }
  }
  const double inf = std::numeric_limits<double>::infinity();
  low_ = {inf, inf};
  Place high{-inf, -inf};
  double largest = 0.0;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    Place low{inf, inf}, top{-inf, -inf};
    for (const std::uint32_t corner : triangles_[t].corners) {
      const Place& at = places_[corner];
      low = {std::min(low.u, at.u), std::min(low.v, at.v)};
      top = {std::max(top.u, at.u), std::max(top.v, at.v)};
    }
    lows_[t] = low;
    low_ = {std::min(low_.u, low.u), std::min(low_.v, low.v)};
    high = {std::max(high.u, low.u), std::max(high.v, low.v)};
    largest = std::max({largest, top.u - low.u, top.v - low.v});
  }
  size_ = std::max({largest, (high.u - low_.u) / kCells, (high.v - low_.v) / kCells, kTinySquared});
  std::fill(begins_.begin(), begins_.end(), 0U);
  const auto cellOf = [&](std::size_t t) {
    return static_cast<std::size_t>(cellAlong(lows_[t].u, low_.u) * kCells + cellAlong(lows_[t].v, low_.v));
  };
  for (std::size_t t = 0; t < triangles_.size(); ++t) ++begins_[cellOf(t) + 1];
  for (std::size_t cell = 1; cell < begins_.size(); ++cell) begins_[cell] += begins_[cell - 1];
  // While a cell is filled its begin moves to its end, which is where the next one begins; then all move back.
  for (std::size_t t = 0; t < triangles_.size(); ++t) sorted_[begins_[cellOf(t)]++] = static_cast<std::uint32_t>(t);
  for (std::size_t cell = begins_.size() - 1; cell > 0; --cell) begins_[cell] = begins_[cell - 1];
  begins_[0] = 0;
}

double LayerShadow::shareAt(std::size_t node, int layer, const Field3& position,
                            const WindSource& wind) const noexcept {
  const Vec3 point = position.at(node), start = wind.origin(point);
  const Place at = places_[node];
  const int u = cellAlong(at.u, low_.u), v = cellAlong(at.v, low_.v);
  // Sheets that were crossed: where, and of which cloth. A line through an edge or a node meets each side of it.
  std::array<std::pair<int, double>, kSheets> sheets;
  std::size_t count = 0;
  double share = 1.0;
  for (int i = std::max(u - 1, 0); i <= u; ++i) {
    for (int j = std::max(v - 1, 0); j <= v; ++j) {
      const auto cell = static_cast<std::size_t>(i * kCells + j);
      for (std::uint32_t k = begins_[cell]; k < begins_[cell + 1] && count < kSheets; ++k) {
        const Triangle& triangle = triangles_[sorted_[k]];
        if (triangle.layer == layer) continue;
        const double at_line = crossing(point, start, position.at(triangle.corners[0]),
                                        position.at(triangle.corners[1]), position.at(triangle.corners[2]));
        const auto same = [&](const std::pair<int, double>& sheet) {
          return sheet.first == triangle.layer && std::abs(sheet.second - at_line) < kEdge;
        };
        const auto end = sheets.begin() + static_cast<std::ptrdiff_t>(count);
        if (at_line < 0.0 || std::any_of(sheets.begin(), end, same)) continue;
        sheets[count++] = {triangle.layer, at_line};
        share *= wind.passes(triangle.corners[0]);
      }
    }
  }
  return share;
}

void LayerShadow::cast(const Field3& position, WindSource& wind) noexcept {
  sortIntoCells(position, wind);
  const Grid& grid = pattern_.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      if (wind.reachesPoint(position.at(n)))
        wind.shade()[n] *= shareAt(n, pattern_.layer[static_cast<std::size_t>(j)], position, wind);
    }
  }
}

}  // namespace curtain
