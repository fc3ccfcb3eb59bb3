// SPDX-License-Identifier: BSD-3-Clause
#include "parts/shear/shear.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "cloth/wide.h"

namespace curtain {
namespace {

Field inverseOf(const Field& lengths) {
  Field out(lengths.size());
  std::transform(lengths.begin(), lengths.end(), out.begin(), [](double length) { return 1.0 / length; });
  return out;
}

// A cell's own largest frequency, with the share of its nodes' masses that belongs to it; that of all cells together
// is no larger (Irons, Treharne 1971).
double fastestCell(const Field& rigidity, const ClothPattern& pattern) {
  const Grid& grid = pattern.grid;
  double fastest = 0.0;
  forEachCell(grid, [&](int i, int j, int left) {
    const double weft = pattern.weft_rest[grid.index(i, j)], warp = pattern.warp_rest[grid.index(i + 1, j)];
    const double per_node = lightestCorner(pattern, i, j, left) * warp * weft;
    fastest = std::max(fastest, rigidity[grid.index(i, j)] * (4.0 * (warp / weft + weft / warp) / per_node));
  });
  return fastest;
}

using Vec2 = Eigen::Vector2d;

// Nodes of open cloth laid flat: along their rows from the middle, and down their columns [m].
void layFlat(const ClothPattern& pattern, const Layers::Layer& layer, std::vector<Vec2>& at) {
  const Grid& grid = pattern.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = layer.first + 1; j < layer.end; ++j)
      at[grid.index(i, j)].x() = at[grid.index(i, j - 1)].x() + pattern.weft_rest[grid.index(i, j)];
    const double middle = 0.5 * at[grid.index(i, layer.end - 1)].x();
    for (int j = layer.first; j < layer.end; ++j) {
      Vec2& node = at[grid.index(i, j)];
      node.x() -= middle;
      if (i == 0) continue;
      const Vec2 above = at[grid.index(i - 1, j)];
      const double rest = pattern.warp_rest[grid.index(i, j)], along = node.x() - above.x();
      node.y() = above.y() + std::sqrt(std::max(0.0, rest * rest - along * along));
    }
  }
}

// The corners of a flat cell: top left, top right, bottom left, bottom right. A ring's are trapezoids side by side.
std::array<Vec2, 4> flatCell(const ClothPattern& pattern, const std::vector<Vec2>& flat, int row, int right, int left) {
  const Grid& grid = pattern.grid;
  const std::size_t n = grid.index(row, right), below = grid.index(row + 1, right);
  if (!grid.closed) return {flat[grid.index(row, left)], flat[n], flat[grid.index(row + 1, left)], flat[below]};
  const double top = 0.5 * pattern.weft_rest[n], bottom = 0.5 * pattern.weft_rest[below],
               rest = pattern.warp_rest[below];
  const double height = std::sqrt(std::max(0.0, rest * rest - (bottom - top) * (bottom - top)));
  return {Vec2(-top, 0.0), Vec2(top, 0.0), Vec2(-bottom, height), Vec2(bottom, height)};
}

}  // namespace

Shear::Shear(const Layers& layers, const ClothPattern& pattern, const Workers& workers)
    : pattern_(pattern), workers_(workers), layers_(layers) {
  if (!layers.anyFabric([](const Fabric& fabric) { return fabric.shear > 0.0; })) return;
  const Grid& grid = pattern.grid;
  const Field rigidity = perCell(grid, layers, [](const Fabric& fabric) { return fabric.shear; });
  omega_squared_ = fastestCell(rigidity, pattern);
  stiffness_.assign(grid.size(), 0.0);
  for (std::size_t n = 0; n < grid.size(); ++n) stiffness_[n] = 0.25 * rigidity[n] * pattern.cell[n];
  per_warp_ = inverseOf(pattern.warp_rest);
  per_weft_ = inverseOf(pattern.weft_rest);
  for (Field& sines : flat_) sines.assign(grid.size(), 0.0);
  std::vector<Vec2> flat(grid.size(), Vec2::Zero());
  for (const Layers::Layer& layer : layers) layFlat(pattern, layer, flat);
  forEachCell(grid, [&](int i, int j, int left) {
    const std::size_t n = grid.index(i, j);
    const std::array<Vec2, 4> at = flatCell(pattern, flat, i, j, left);
    const Vec2 top = at[1] - at[0], bottom = at[3] - at[2], on_left = at[2] - at[0], on_right = at[3] - at[1];
    flat_[0][n] = top.dot(on_left);
    flat_[1][n] = top.dot(on_right);
    flat_[2][n] = bottom.dot(on_left);
    flat_[3][n] = bottom.dot(on_right);
  });
  assign(grid.size());
  cells_.emplace(grid);
}

// The cells between a row and the next but that at the seam.
CURTAIN_WIDE void Shear::shearCells(const Field3& position, int row, CellCorners& corners) const noexcept {
  const auto columns = static_cast<std::size_t>(pattern_.grid.columns);
  const std::size_t first = pattern_.grid.row(row), second = pattern_.grid.row(row + 1);
  const ConstFieldView a(position, first), b(position, second);
  const double *const per_top = per_weft_.data() + first, *const per_bottom = per_weft_.data() + second,
                      *const per_warp = per_warp_.data() + second, *const stiffness = stiffness_.data() + first,
                      *const flat_ef = flat_[0].data() + first, *const flat_eg = flat_[1].data() + first,
                      *const flat_df = flat_[2].data() + first, *const flat_dg = flat_[3].data() + first;
  const FieldView tl(corners.top_left, 0), tr(corners.top_right, 0), bl(corners.bottom_left, 0),
      br(corners.bottom_right, 0);
  const double share = this->share();
#pragma omp simd
  for (std::size_t j = 1; j < columns; ++j) {
    const double ex = a.x[j] - a.x[j - 1], ey = a.y[j] - a.y[j - 1], ez = a.z[j] - a.z[j - 1];              // top
    const double dx = b.x[j] - b.x[j - 1], dy = b.y[j] - b.y[j - 1], dz = b.z[j] - b.z[j - 1];              // bottom
    const double fx = b.x[j - 1] - a.x[j - 1], fy = b.y[j - 1] - a.y[j - 1], fz = b.z[j - 1] - a.z[j - 1];  // left
    const double gx = b.x[j] - a.x[j], gy = b.y[j] - a.y[j], gz = b.z[j] - a.z[j];                          // right
    double ef = ex * fx + ey * fy + ez * fz - flat_ef[j], eg = ex * gx + ey * gy + ez * gz - flat_eg[j];
    double df = dx * fx + dy * fy + dz * fz - flat_df[j], dg = dx * gx + dy * gy + dz * gz - flat_dg[j];
    const double warped = 0.25 * (ef - eg - df + dg), k = share * stiffness[j];
    ef = k * (ef - warped) * per_top[j] * per_warp[j - 1];
    eg = k * (eg + warped) * per_top[j] * per_warp[j];
    df = k * (df + warped) * per_bottom[j] * per_warp[j - 1];
    dg = k * (dg - warped) * per_bottom[j] * per_warp[j];
    const double rest = 0.25 * (ef - eg - df + dg);  // what moves p moves w; 0 but for tapered cells
    ef -= rest;
    eg += rest;
    df += rest;
    dg -= rest;
    // Gradients by the edges: of the top ef f + eg g, of the bottom df f + dg g, of the left ef e + df d, of the right.
    tl.x[j] = ef * fx + eg * gx + ef * ex + df * dx;
    tl.y[j] = ef * fy + eg * gy + ef * ey + df * dy;
    tl.z[j] = ef * fz + eg * gz + ef * ez + df * dz;
    tr.x[j] = eg * ex + dg * dx - (ef * fx + eg * gx);
    tr.y[j] = eg * ey + dg * dy - (ef * fy + eg * gy);
    tr.z[j] = eg * ez + dg * dz - (ef * fz + eg * gz);
    bl.x[j] = df * fx + dg * gx - (ef * ex + df * dx);
    bl.y[j] = df * fy + dg * gy - (ef * ey + df * dy);
    bl.z[j] = df * fz + dg * gz - (ef * ez + df * dz);
    br.x[j] = -(df * fx + dg * gx) - (eg * ex + dg * dx);
    br.y[j] = -(df * fy + dg * gy) - (eg * ey + dg * dy);
    br.z[j] = -(df * fz + dg * gz) - (eg * ez + dg * dz);
  }
}

// The cell that closes a ring, between its last column and its first.
void Shear::shearSeam(const Field3& position, int row, CellCorners& corners) const noexcept {
  const Grid& grid = pattern_.grid;
  const std::size_t n = grid.index(row, 0), below = grid.index(row + 1, 0), last = grid.index(row, grid.columns - 1),
                    last_below = grid.index(row + 1, grid.columns - 1);
  const Vec3 top = position.at(n) - position.at(last), bottom = position.at(below) - position.at(last_below);
  const Vec3 left = position.at(last_below) - position.at(last), right = position.at(below) - position.at(n);
  double ef = top.dot(left) - flat_[0][n], eg = top.dot(right) - flat_[1][n];
  double df = bottom.dot(left) - flat_[2][n], dg = bottom.dot(right) - flat_[3][n];
  const double warped = 0.25 * (ef - eg - df + dg), k = share() * stiffness_[n];
  ef = k * (ef - warped) * per_weft_[n] * per_warp_[last_below];
  eg = k * (eg + warped) * per_weft_[n] * per_warp_[below];
  df = k * (df + warped) * per_weft_[below] * per_warp_[last_below];
  dg = k * (dg - warped) * per_weft_[below] * per_warp_[below];
  const double rest = 0.25 * (ef - eg - df + dg);
  ef -= rest;
  eg += rest;
  df += rest;
  dg -= rest;
  const Vec3 of_top = ef * left + eg * right, of_bottom = df * left + dg * right;
  const Vec3 of_left = ef * top + df * bottom, of_right = eg * top + dg * bottom;
  corners.top_left.set(0, of_top + of_left);
  corners.top_right.set(0, of_right - of_top);
  corners.bottom_left.set(0, of_bottom - of_left);
  corners.bottom_right.set(0, -of_bottom - of_right);
}

void Shear::addOwn(const Field3& position, Field3& sum) noexcept {
  const auto fill = [&](int row, CellCorners& corners) {
    shearCells(position, row, corners);
    if (pattern_.grid.closed) shearSeam(position, row, corners);
  };
  cells_->add(pattern_.grid, workers_, fill, sum);
}

double Shear::energyAt(const Field3& position) const noexcept {
  const Grid& grid = pattern_.grid;
  double sum = 0.0;
  forEachCell(grid, [&](int i, int j, int left) {
    const std::size_t n = grid.index(i, j);
    const std::size_t below = grid.index(i + 1, j), on_left = grid.index(i, left), left_below = grid.index(i + 1, left);
    const Vec3 top = position.at(n) - position.at(on_left), bottom = position.at(below) - position.at(left_below);
    const Vec3 before = position.at(left_below) - position.at(on_left), after = position.at(below) - position.at(n);
    const double ef = top.dot(before) - flat_[0][n], eg = top.dot(after) - flat_[1][n];
    const double df = bottom.dot(before) - flat_[2][n], dg = bottom.dot(after) - flat_[3][n];
    const double warped = 0.25 * (ef - eg - df + dg);
    const auto corner = [&](double p, double per) { sum += 0.5 * share() * stiffness_[n] * p * p * per; };
    corner(ef - warped, per_weft_[n] * per_warp_[left_below]);
    corner(eg + warped, per_weft_[n] * per_warp_[below]);
    corner(df + warped, per_weft_[below] * per_warp_[left_below]);
    corner(dg - warped, per_weft_[below] * per_warp_[below]);
  });
  return sum;
}

bool Shear::explain(const ClothState&, double, Plan& plan) const {
  std::ostringstream text;
  if (any())
    text << listOf(layers_, [](const Fabric& fabric) { return fabric.shear; }) << " N/m"
         << (share() < 1.0 ? ", of which the substeps bear a part" : "");
  plan.push_back({"shear", any(), any() ? text.str() : "cloth.shear is 0"});
  return false;
}

}  // namespace curtain
