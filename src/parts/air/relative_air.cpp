// SPDX-License-Identifier: BSD-3-Clause
#include "parts/air/relative_air.h"

#include <algorithm>
#include <cmath>

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
struct Substep {
  double normal, tangential;  // 1/2 rho c [kg/m^3], normal: of cloth without pores
  double kick;                // [s]
  double pulls;               // 1: there are pulls; 0: there are none
};

// A row of nodes.
struct NodeRow {
  const double *inverse_mass, *area, *solid;
  ConstFieldView area_vector, wind, velocity, pull;
  FieldView force;
};

template <bool kBackward>
CURTAIN_INTO_WIDE void addRow(int columns, const NodeRow row, const Substep drag) {
  const auto& [inverse_mass, areas, solid, area_vector, wind, velocity, pull, force] = row;
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
    const double bn = 0.5 * (drag.normal * solid[j]) * size, bt = drag.tangential * areas[j];
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

CURTAIN_WIDE void addMiddle(int columns, const NodeRow& row, const Substep& drag) noexcept {
  addRow<false>(columns, row, drag);
}
CURTAIN_WIDE void addEnd(int columns, const NodeRow& row, const Substep& drag) noexcept {
  addRow<true>(columns, row, drag);
}

}  // namespace

RelativeAir::RelativeAir(const AirParams& air, const Layers& layers, const ClothPattern& pattern,
                         const AmbientParams& ambient)
    : air_(air), layers_(layers), pattern_(pattern), ambient_(ambient) {
  area_vectors_.assign(pattern.grid.size(), 0.0);
  solid_.assign(pattern.grid.size(), 1.0);
  for (int i = 0; i < pattern.grid.rows; ++i) {
    for (int j = 0; j < pattern.grid.columns; ++j)
      solid_[pattern.grid.index(i, j)] = 1.0 - layers.fabricAt(i, j).porosity;
  }
  kept_.reserve(pattern.grid.nodeCount());
  resume();
}

RelativeAir::Drag RelativeAir::dragOf(const Layers::Layer& layer) const noexcept {
  if (air_.law != AirLaw::kRelative) return {0.0, 0.0};
  const double normal = layer.air != nullptr ? layer.air->normal_drag : air_.normal_drag;
  const double tangential = layer.air != nullptr ? layer.air->tangential_drag : air_.tangential_drag;
  return {0.5 * air_.density * normal, 0.5 * air_.density * tangential};
}

void RelativeAir::resume() {
  largest_ = 0.0;
  for (const Layers::Layer& layer : layers_) {
    const Drag drag = dragOf(layer);
    double solid = 0.0;
    for (int i = 0; i < pattern_.grid.rows; ++i) {
      for (int j = layer.first; j < layer.end; ++j) solid = std::max(solid, solid_[pattern_.grid.index(i, j)]);
    }
    largest_ = std::max({largest_, drag.normal * solid, drag.tangential});
  }
}

double RelativeAir::dampingPerMass(double& air_speed) const noexcept {
  if (!active()) return 0.0;
  double area_per_mass = 0.0;  // of the lightest node [m^2/kg]
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    area_per_mass = std::max(area_per_mass, pattern_.area[n] * pattern_.inverse_mass[n]);
  }
  air_speed += ambient_.meanSpeed();
  return largest_ * air_speed * area_per_mass;
}

void RelativeAir::announce(const ClothState& state, ForceSum& sum) noexcept {
  if (!active()) return;
  sum.acts = sum.reads_air = true;
  ambient_.setVelocities(pattern_.grid, state.position, sum.time, sum.air);
}

void RelativeAir::addForces(const ClothState& state, ForceSum& sum) noexcept {
  if (!active()) return;
  kept_.clear();
  for (const std::size_t n : sum.led) kept_.push_back(sum.force.at(n));
  const Grid& grid = pattern_.grid;
  nodeAreaVectors(grid, state.position, area_vectors_);
  const SubstepAhead& ahead = sum.ahead;
  for (const Layers::Layer& layer : layers_) {
    const Drag drag = dragOf(layer);
    const Substep substep{drag.normal, drag.tangential, ahead.kick, ahead.pull != nullptr ? 1.0 : 0.0};
    for (int i = 0; i < grid.rows; ++i) {
      const std::size_t row = grid.index(i, layer.first);
      const ConstFieldView pull(ahead.pull != nullptr ? *ahead.pull : sum.air, row);  // read unconditionally
      const NodeRow nodes{pattern_.inverse_mass.data() + row,
                          pattern_.area.data() + row,
                          solid_.data() + row,
                          {area_vectors_, row},
                          {sum.air, row},
                          {state.velocity, row},
                          pull,
                          {sum.force, row}};
      (ahead.backward ? addEnd : addMiddle)(layer.end - layer.first, nodes, substep);
    }
  }
  for (std::size_t k = 0; k < kept_.size(); ++k) sum.force.set(sum.led[k], kept_[k]);
}

bool RelativeAir::explain(const ClothState&, double, Plan& plan) const {
  const bool blows = active() && !ambient_.still();
  plan.push_back({"ambient wind", blows,
                  !blows             ? "the air around is still"
                  : ambient_.gusty() ? "blows everywhere, with gusts"
                                     : "blows everywhere; no gusts, so no table of them"});
  plan.push_back({"relative air", active(),
                  active() ? "the force of the air's velocity relative to the cloth, with normals of all rows"
                           : "another law is asked for (air.law), or no drag"});
  return active();
}

}  // namespace curtain
