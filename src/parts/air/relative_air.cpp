// SPDX-License-Identifier: BSD-3-Clause
#include "parts/air/relative_air.h"

#include <algorithm>
#include <cmath>

#include "cloth/tiny_squared.h"
#include "cloth/wide.h"

namespace curtain {
namespace {

// Mean of a component of the relative velocity over the kick, or its end: from u at its start, what the other forces
// add to the node's velocity, and z = coefficient * inverse mass * kick. That of the middle is of AirDamping's
// DampedStep.
template <bool kBackward>
CURTAIN_INTO_WIDE double meanOf(double u, double gained, double z) {
  if (kBackward) return (u - gained) / (1.0 + z);
  return ((1.0 + 0.5 * z) * u - 0.5 * (1.0 + z) * gained) / (1.0 + z + 0.5 * z * z);
}

// Constants of addForces().
struct Drag {
  double normal, tangential;  // 1/2 rho c [kg/m^3]
  double kick;                // [s]
  double pulls;               // 1: there are pulls; 0: there are none
};

// A row of nodes.
struct NodeRow {
  const double *inverse_mass, *area;
  ConstFieldView area_vector, wind, velocity, pull;
  FieldView force;
};

template <bool kBackward>
CURTAIN_INTO_WIDE void addRow(int columns, const NodeRow row, const Drag drag) {
  const auto& [inverse_mass, areas, area_vector, wind, velocity, pull, force] = row;
  const double kick = drag.kick, pulled = drag.kick * drag.pulls;
#pragma omp simd
  for (int j = 0; j < columns; ++j) {
    const double sx = area_vector.x[j], sy = area_vector.y[j], sz = area_vector.z[j];
    const double size = std::sqrt(sx * sx + sy * sy + sz * sz + kTinySquared);
    const double nx = sx / size, ny = sy / size, nz = sz / size;
    // Relative velocity and gain, and their parts along the normal (n) and the cloth.
    const double ux = wind.x[j] - velocity.x[j], uy = wind.y[j] - velocity.y[j], uz = wind.z[j] - velocity.z[j];
    const double kw = kick * inverse_mass[j];
    const double gx = kw * force.x[j] + pulled * pull.x[j], gy = kw * force.y[j] + pulled * pull.y[j],
                 gz = kw * force.z[j] + pulled * pull.z[j];
    const double un = ux * nx + uy * ny + uz * nz, gn = gx * nx + gy * ny + gz * nz;
    const double tx = ux - un * nx, ty = uy - un * ny, tz = uz - un * nz;
    const double hx = gx - gn * nx, hy = gy - gn * ny, hz = gz - gn * nz;
    // The corner triangles of nodeAreaVectors() are twice the node's share.
    const double bn = 0.5 * drag.normal * size, bt = drag.tangential * areas[j];
    // First with the speed at the start, then with that of the mean: of second order.
    const double first = std::sqrt(ux * ux + uy * uy + uz * uz);
    const double zn = bn * first * kw, zt = bt * first * kw;
    const double in = meanOf<kBackward>(un, gn, zn), ix = meanOf<kBackward>(tx, hx, zt),
                 iy = meanOf<kBackward>(ty, hy, zt), iz = meanOf<kBackward>(tz, hz, zt);
    const double speed = std::sqrt(in * in + ix * ix + iy * iy + iz * iz);
    const double yn = bn * speed * kw, yt = bt * speed * kw;
    const double push = bn * speed * meanOf<kBackward>(un, gn, yn), rub = bt * speed;
    force.x[j] += push * nx + rub * meanOf<kBackward>(tx, hx, yt);
    force.y[j] += push * ny + rub * meanOf<kBackward>(ty, hy, yt);
    force.z[j] += push * nz + rub * meanOf<kBackward>(tz, hz, yt);
  }
}

CURTAIN_WIDE void addMiddle(int columns, const NodeRow& row, const Drag& drag) noexcept {
  addRow<false>(columns, row, drag);
}
CURTAIN_WIDE void addEnd(int columns, const NodeRow& row, const Drag& drag) noexcept {
  addRow<true>(columns, row, drag);
}

}  // namespace

RelativeAir::RelativeAir(const AirParams& air, double porosity, const ClothPattern& pattern)
    : density_(air.density),
      normal_(air.law == AirLaw::kRelative ? 0.5 * air.density * air.normal_drag * (1.0 - porosity) : 0.0),
      tangential_(air.law == AirLaw::kRelative ? 0.5 * air.density * air.tangential_drag : 0.0) {
  takePins(pattern);
}

void RelativeAir::takePins(const ClothPattern& pattern) noexcept {
  area_per_mass_ = 0.0;
  for (std::size_t n = 0; n < pattern.grid.size(); ++n) {
    area_per_mass_ = std::max(area_per_mass_, pattern.area[n] * pattern.inverse_mass[n]);
  }
}

double RelativeAir::strongestPerMass(double speed) const noexcept {
  return std::max(normal_, tangential_) * speed * area_per_mass_;
}

void RelativeAir::addForces(const ClothPattern& pattern, const Field3& area_vectors, const Field3& wind,
                            const Field3& velocity, const SubstepAhead& ahead, Field3& force) const noexcept {
  const Grid& grid = pattern.grid;
  const Drag drag{normal_, tangential_, ahead.kick, ahead.pull != nullptr ? 1.0 : 0.0};
  for (int i = 0; i < grid.rows; ++i) {
    const std::size_t row = grid.row(i);
    const ConstFieldView pull(ahead.pull != nullptr ? *ahead.pull : wind, row);  // read unconditionally
    const NodeRow nodes{pattern.inverse_mass.data() + row,
                        pattern.area.data() + row,
                        {area_vectors, row},
                        {wind, row},
                        {velocity, row},
                        pull,
                        {force, row}};
    (ahead.backward ? addEnd : addMiddle)(grid.columns, nodes, drag);
  }
}

}  // namespace curtain
