// SPDX-License-Identifier: BSD-3-Clause
#include "parts/twist/twist.h"

#include <algorithm>
#include <sstream>

#include "cloth/wide.h"

namespace curtain {
namespace {

struct Corners {
  std::size_t a, b, c, d;  // top left, top right, bottom left, bottom right
};

// Six times the volume between the corners.
double volumeOf(const Corners& at, const Field3& position) noexcept {
  const Vec3 a = position.at(at.a), b = position.at(at.b) - a, c = position.at(at.c) - a, d = position.at(at.d) - a;
  return b.dot(c.cross(d));
}

}  // namespace

Twist::Twist(const Layers& layers, const ClothPattern& pattern, const Workers& workers)
    : pattern_(pattern), workers_(workers), layers_(layers) {
  const auto twistOf = [](const Fabric& fabric) { return fabric.twist(); };
  if (!layers.anyFabric([&](const Fabric& fabric) { return twistOf(fabric) > 0.0; })) return;
  const Grid& grid = pattern.grid;
  const Field rigidity = perCell(grid, layers, twistOf);
  stiffness_.assign(grid.size(), 0.0);
  forEachCell(grid, [&](int i, int j, int left) {
    const std::size_t n = grid.index(i, j), below = grid.index(i + 1, j);
    const double top = pattern.weft_rest[n], bottom = pattern.weft_rest[below];
    const double on_left = pattern.warp_rest[grid.index(i + 1, left)], on_right = pattern.warp_rest[below];
    const double area = 0.25 * (top + bottom) * (on_left + on_right), edges = top * bottom * on_left * on_right;
    const double stiffness = 4.0 * rigidity[n] * area / (edges * edges);
    stiffness_[n] = pattern.cell[n] * stiffness;
    // Its own frequency, with the share of its nodes' masses that belongs to it. The slope of V at a node is twice the
    // area of the others' triangle at most.
    const double slope = std::max(top, bottom) * std::max(on_left, on_right);
    omega_squared_ =
        std::max(omega_squared_, 16.0 * stiffness * slope * slope / (lightestCorner(pattern, i, j, left) * area));
  });
  assign(grid.size());
  cells_.emplace(grid);
}

// The cells between a row and the next but that at the seam. The slopes of V by b, c, d are c x d, d x b, b x c.
CURTAIN_WIDE void Twist::twistCells(const Field3& position, int row, CellCorners& corners) const noexcept {
  const auto columns = static_cast<std::size_t>(pattern_.grid.columns);
  const std::size_t first = pattern_.grid.row(row);
  const ConstFieldView x(position, first), y(position, pattern_.grid.row(row + 1));
  const double* const stiffness = stiffness_.data() + first;
  const FieldView tl(corners.top_left, 0), tr(corners.top_right, 0), bl(corners.bottom_left, 0),
      br(corners.bottom_right, 0);
  const double share = this->share();
#pragma omp simd
  for (std::size_t j = 1; j < columns; ++j) {
    const double ax = x.x[j - 1], ay = x.y[j - 1], az = x.z[j - 1];
    const double bx = x.x[j] - ax, by = x.y[j] - ay, bz = x.z[j] - az;
    const double cx = y.x[j - 1] - ax, cy = y.y[j - 1] - ay, cz = y.z[j - 1] - az;
    const double dx = y.x[j] - ax, dy = y.y[j] - ay, dz = y.z[j] - az;
    const double ux = cy * dz - cz * dy, uy = cz * dx - cx * dz, uz = cx * dy - cy * dx;
    const double k = -share * stiffness[j] * (bx * ux + by * uy + bz * uz);
    tr.x[j] = k * ux;
    tr.y[j] = k * uy;
    tr.z[j] = k * uz;
    bl.x[j] = k * (dy * bz - dz * by);
    bl.y[j] = k * (dz * bx - dx * bz);
    bl.z[j] = k * (dx * by - dy * bx);
    br.x[j] = k * (by * cz - bz * cy);
    br.y[j] = k * (bz * cx - bx * cz);
    br.z[j] = k * (bx * cy - by * cx);
    tl.x[j] = -(tr.x[j] + bl.x[j] + br.x[j]);
    tl.y[j] = -(tr.y[j] + bl.y[j] + br.y[j]);
    tl.z[j] = -(tr.z[j] + bl.z[j] + br.z[j]);
  }
}

// The cell that closes a ring, between its last column and its first.
void Twist::twistSeam(const Field3& position, int row, CellCorners& corners) const noexcept {
  const Grid& grid = pattern_.grid;
  const std::size_t n = grid.index(row, 0);
  const Vec3 a = position.at(grid.index(row, grid.columns - 1)), b = position.at(n) - a,
             c = position.at(grid.index(row + 1, grid.columns - 1)) - a, d = position.at(grid.index(row + 1, 0)) - a;
  const Vec3 by_b = c.cross(d), by_c = d.cross(b), by_d = b.cross(c);
  const double k = -share() * stiffness_[n] * b.dot(by_b);
  corners.top_right.set(0, k * by_b);
  corners.bottom_left.set(0, k * by_c);
  corners.bottom_right.set(0, k * by_d);
  corners.top_left.set(0, -k * (by_b + by_c + by_d));
}

void Twist::addOwn(const Field3& position, Field3& sum) noexcept {
  const auto fill = [&](int row, CellCorners& corners) {
    twistCells(position, row, corners);
    if (pattern_.grid.closed) twistSeam(position, row, corners);
  };
  cells_->add(pattern_.grid, workers_, fill, sum);
}

double Twist::energyAt(const Field3& position) const noexcept {
  const Grid& grid = pattern_.grid;
  double sum = 0.0;
  forEachCell(grid, [&](int i, int j, int left) {
    const std::size_t n = grid.index(i, j);
    const double volume = volumeOf({grid.index(i, left), n, grid.index(i + 1, left), grid.index(i + 1, j)}, position);
    sum += 0.5 * share() * stiffness_[n] * volume * volume;
  });
  return sum;
}

bool Twist::explain(const ClothState&, double, Plan& plan) const {
  std::ostringstream text;
  if (any()) {
    text << listOf(layers_, [](const Fabric& fabric) { return fabric.twist(); }) << " N m"
         << (share() < 1.0 ? ", of which the substeps bear a part" : "");
  } else if (layers_.anyFabric([](const Fabric& fabric) { return fabric.bending_bias > 0.0; })) {
    text << "cloth.bending_bias is no more than warp and weft lines give";
  } else {
    text << "cloth.bending_bias is 0";
  }
  plan.push_back({"twist", any(), text.str()});
  return false;
}

}  // namespace curtain
