// SPDX-License-Identifier: BSD-3-Clause
//
// Position based dynamics, Mueller, Heidelberger, Hennix, Ratcliff 2007: predict, project the links one after the other
// (Gauss-Seidel, from the hung edge down), take the velocity from the way. Stiffness 1: a softer one is only less true.
#include <cmath>

#include "bench/rivals/grid_state.h"
#include "bench/rivals/projection.h"
#include "bench/rivals/rivals.h"

namespace curtain_bench {
namespace {

#define CURTAIN_RESTRICT __restrict__

// Mueller et al. 2007, Eqs. (10), (11), for count links none of which share a node.
void projectBatch(double* CURTAIN_RESTRICT ax, double* CURTAIN_RESTRICT ay, double* CURTAIN_RESTRICT az,
                  const double* CURTAIN_RESTRICT wa, double* CURTAIN_RESTRICT bx, double* CURTAIN_RESTRICT by,
                  double* CURTAIN_RESTRICT bz, const double* CURTAIN_RESTRICT wb, double rest, double slack,
                  std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) {
    const double dx = bx[k] - ax[k], dy = by[k] - ay[k], dz = bz[k] - az[k];
    const double length = std::sqrt(dx * dx + dy * dy + dz * dz);
    const double stretch = length - rest;
    const double held = stretch > slack ? stretch : 0.0;
    const double s = held / (length * (wa[k] + wb[k]) + kTinyDenominator);
    const double sa = s * wa[k], sb = s * wb[k];
    ax[k] += sa * dx;
    ay[k] += sa * dy;
    az[k] += sa * dz;
    bx[k] -= sb * dx;
    by[k] -= sb * dy;
    bz[k] -= sb * dz;
  }
}

class Pbd : public ProjectionContestant {
 public:
  using ProjectionContestant::ProjectionContestant;

 private:
  void projectLinks() override {
    Triple& x = state_.position;
    const std::vector<double>& w = state_.inverse_mass;
    for (const LinkBatch& batch : state_.batches) {
      const std::size_t a = batch.a, b = batch.b;
      projectBatch(&x.x[a], &x.y[a], &x.z[a], &w[a], &x.x[b], &x.y[b], &x.z[b], &w[b], batch.rest,
                   batch.two_sided ? -INFINITY : 0.0, batch.count);
    }
  }
};

}  // namespace

std::unique_ptr<Contestant> makePbd(const ClothStart& start, const PositionSettings& settings) {
  return std::make_unique<Pbd>(start, settings);
}

}  // namespace curtain_bench
