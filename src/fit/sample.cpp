// SPDX-License-Identifier: BSD-3-Clause
#include "fit/sample.h"

#include <algorithm>
#include <cmath>

#include "fit/drape.h"
#include "scene/pi.h"

namespace curtain_fit {
namespace {

using curtain::ClothPattern;
using curtain::Grid;
using curtain::Scene;
using curtain::Vec3;

// Of a whole node's mass, what nodes outside the circle keep: lines end where they end in the grid, and a node without
// mass has no motion. They are 0.6 % of the sample's mass.
constexpr double kMinShare = 0.03;

// Air that slows the sample down by 10 / s at 0.12 kg/m^2: it sinks in a second or two and does not swing.
constexpr double kAir = 1.0;  // AirParams::inside [m/s]

// Share of the cell below a node, on its left, that lies in the circle: of points spread evenly over it.
double shareInCircle(const Grid& grid, int row, int column) {
  constexpr int kPoints = 16;  // along each side
  const Vec3 corner = flatPlace(grid, row, column - 1), across = flatPlace(grid, row + 1, column) - corner;
  int inside = 0;
  for (int u = 0; u < kPoints; ++u) {
    for (int v = 0; v < kPoints; ++v) {
      const double x = corner.x() + (v + 0.5) / kPoints * across.x(), y = corner.y() + (u + 0.5) / kPoints * across.y();
      if (x * x + y * y < kSampleRadius * kSampleRadius) ++inside;
    }
  }
  return static_cast<double>(inside) / (kPoints * kPoints);
}

}  // namespace

Vec3 flatPlace(const Grid& grid, int row, int column) {
  const double spacing = 2.0 * kSampleRadius / (grid.rows - 1);
  return {column * spacing - kSampleRadius, kSampleRadius - row * spacing, 0.0};
}

Scene sheetOf(const curtain::ClothParams& cloth, int nodes) {
  Scene scene;
  scene.cloth = cloth;
  scene.cloth.rows = scene.cloth.columns = nodes;
  scene.cloth.height = scene.cloth.width = 2.0 * kSampleRadius;
  scene.cloth.folds = 1;
  scene.hang.from = Vec3(-kSampleRadius, kSampleRadius, 0.0);
  scene.hang.to = Vec3(kSampleRadius, kSampleRadius, 0.0);
  scene.hang.tilt = 0.5 * curtain::kPi;
  scene.pins.kind = curtain::PinKind::kList;
  const Grid grid(nodes, nodes, false);
  for (int i = 0; i < nodes; ++i) {
    for (int j = 0; j < nodes; ++j) {
      if (flatPlace(grid, i, j).norm() <= kDiscRadius) scene.pins.nodes.push_back({i, j});
    }
  }
  scene.air.inside = scene.air.border = scene.air.corner = kAir;
  scene.solver.max_substeps = 10000;  // what stiff cloth needs
  return scene;
}

ClothPattern roundSample(const Scene& sheet) {
  ClothPattern pattern = makePattern(sheet);
  const Grid& grid = pattern.grid;
  forEachCell(grid, [&](int i, int j, int) { pattern.cell[grid.index(i, j)] = shareInCircle(grid, i, j); });
  const double spacing = 2.0 * kSampleRadius / (grid.rows - 1), whole = spacing * spacing;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      double cells = 0.0, cloth = 0.0;
      for (const int row : {i - 1, i}) {
        for (const int column : {j, j + 1}) {
          if (row < 0 || row + 1 >= grid.rows || column < 1 || column >= grid.columns) continue;
          cells += 1.0;
          cloth += pattern.cell[grid.index(row, column)];
        }
      }
      const std::size_t n = grid.index(i, j);
      pattern.area[n] = whole * std::max(0.25 * cloth, kMinShare);
      pattern.mass[n] = sheet.cloth.surface_density * pattern.area[n];
      if (pattern.pinned[n] == curtain::kFree) pattern.inverse_mass[n] = 1.0 / pattern.mass[n];
      // Of the strip of cloth along each line through the node so much is left.
      for (curtain::Field* const bending : {&pattern.warp_bending, &pattern.weft_bending}) {
        if (!bending->empty()) (*bending)[n] *= cloth / cells;
      }
    }
  }
  return pattern;
}

}  // namespace curtain_fit
