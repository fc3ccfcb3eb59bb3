// SPDX-License-Identifier: BSD-3-Clause
#include "bench/rivals/spring_forces.h"

#include <cmath>

#define CURTAIN_RESTRICT __restrict__

namespace curtain_bench {
namespace {

constexpr double kTiny = 1e-30;  // [m^2] keeps coincident nodes finite

struct Spring {
  double rest;
  double stiffness;
  double dashpot;
  double slack;  // 0: a string pushes nothing; -infinity: a rod does
};

// A function of its own for each side of the link: restrict parameters are what lets the compiler widen the loop.
void addBatch(const double* CURTAIN_RESTRICT ax, const double* CURTAIN_RESTRICT ay, const double* CURTAIN_RESTRICT az,
              const double* CURTAIN_RESTRICT bx, const double* CURTAIN_RESTRICT by, const double* CURTAIN_RESTRICT bz,
              double* CURTAIN_RESTRICT fax, double* CURTAIN_RESTRICT fay, double* CURTAIN_RESTRICT faz,
              double* CURTAIN_RESTRICT fbx, double* CURTAIN_RESTRICT fby, double* CURTAIN_RESTRICT fbz,
              std::size_t count, const Spring spring) {
  for (std::size_t k = 0; k < count; ++k) {
    const double dx = bx[k] - ax[k], dy = by[k] - ay[k], dz = bz[k] - az[k];
    const double length = std::sqrt(dx * dx + dy * dy + dz * dz + kTiny);
    const double stretch = length - spring.rest;
    const double held = stretch > spring.slack ? stretch : 0.0;
    const double pull = spring.stiffness * held / length;
    fax[k] += pull * dx;
    fay[k] += pull * dy;
    faz[k] += pull * dz;
    fbx[k] -= pull * dx;
    fby[k] -= pull * dy;
    fbz[k] -= pull * dz;
  }
}

// The dashpots, apart: most settings have none. They act where the spring does.
void addDashpots(const GridState& state, const Triple& position, const Triple& velocity, double dashpot,
                 Triple& force) {
  for (const LinkBatch& batch : state.batches) {
    for (std::size_t k = 0; k < batch.count; ++k) {
      const std::size_t a = batch.a + k, b = batch.b + k;
      const double dx = position.x[b] - position.x[a], dy = position.y[b] - position.y[a],
                   dz = position.z[b] - position.z[a];
      const double length2 = dx * dx + dy * dy + dz * dz + kTiny;
      if (!batch.two_sided && length2 <= batch.rest * batch.rest) continue;
      const double rate = (velocity.x[b] - velocity.x[a]) * dx + (velocity.y[b] - velocity.y[a]) * dy +
                          (velocity.z[b] - velocity.z[a]) * dz;
      const double pull = dashpot * rate / length2;
      force.x[a] += pull * dx;
      force.y[a] += pull * dy;
      force.z[a] += pull * dz;
      force.x[b] -= pull * dx;
      force.y[b] -= pull * dy;
      force.z[b] -= pull * dz;
    }
  }
}

}  // namespace

void springForces(const GridState& state, const Triple& position, const Triple& velocity, double stiffness,
                  double dashpot, Triple& force) {
  const std::size_t count = state.count();
#pragma omp simd
  for (std::size_t n = 0; n < count; ++n) {
    force.x[n] = state.mass[n] * state.gravity[0];
    force.y[n] = state.mass[n] * state.gravity[1];
    force.z[n] = state.mass[n] * state.gravity[2];
  }
  for (const LinkBatch& batch : state.batches) {
    const std::size_t a = batch.a, b = batch.b;
    addBatch(&position.x[a], &position.y[a], &position.z[a], &position.x[b], &position.y[b], &position.z[b],
             &force.x[a], &force.y[a], &force.z[a], &force.x[b], &force.y[b], &force.z[b], batch.count,
             {batch.rest, stiffness, 0.0, batch.two_sided ? -INFINITY : 0.0});
  }
  if (dashpot > 0.0) addDashpots(state, position, velocity, dashpot, force);
}

}  // namespace curtain_bench
