// SPDX-License-Identifier: BSD-3-Clause
//
// XPBD, Macklin, Mueller, Chentanez 2016: PBD whose links have a compliance and multipliers, so that stiffness does not
// hang on the number of iterations. With one iteration a substep it is Macklin et al. 2019, "Small Steps in Physics
// Simulation".
#include <algorithm>
#include <cmath>

#include "bench/rivals/grid_state.h"
#include "bench/rivals/projection.h"
#include "bench/rivals/rivals.h"

namespace curtain_bench {
namespace {

#define CURTAIN_RESTRICT __restrict__

// Macklin et al. 2016, Eqs. (17), (18), for links none of which share a node; alpha = compliance / h^2 [1/kg]. The
// multiplier of a string never pushes: highest = 0; a rod's may: highest = infinity.
void projectBatch(double* CURTAIN_RESTRICT ax, double* CURTAIN_RESTRICT ay, double* CURTAIN_RESTRICT az,
                  const double* CURTAIN_RESTRICT wa, double* CURTAIN_RESTRICT bx, double* CURTAIN_RESTRICT by,
                  double* CURTAIN_RESTRICT bz, const double* CURTAIN_RESTRICT wb, double* CURTAIN_RESTRICT multiplier,
                  double rest, double highest, double alpha, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) {
    const double dx = bx[k] - ax[k], dy = by[k] - ay[k], dz = bz[k] - az[k];
    const double length = std::sqrt(dx * dx + dy * dy + dz * dz);
    const double old = multiplier[k];
    const double wished = old + (rest - length - alpha * old) / (wa[k] + wb[k] + alpha + kTinyDenominator);
    const double now = wished < highest ? wished : highest;
    multiplier[k] = now;
    const double s = (now - old) / (length + kTinyDenominator);
    const double sa = s * wa[k], sb = s * wb[k];
    ax[k] -= sa * dx;
    ay[k] -= sa * dy;
    az[k] -= sa * dz;
    bx[k] += sb * dx;
    by[k] += sb * dy;
    bz[k] += sb * dz;
  }
}

class Xpbd : public ProjectionContestant {
 public:
  Xpbd(const ClothStart& start, const PositionSettings& settings)
      : ProjectionContestant(start, settings), alpha_(settings.compliance / (h_ * h_)) {
    multiplier_.assign(state_.link_count, 0.0);
  }

  double elasticEnergy() const override {
    return settings_.compliance > 0.0 ? springEnergy(state_, 1.0 / settings_.compliance) : 0.0;
  }

 private:
  void begin() override { std::fill(multiplier_.begin(), multiplier_.end(), 0.0); }

  void projectLinks() override {
    Triple& x = state_.position;
    const std::vector<double>& w = state_.inverse_mass;
    for (const LinkBatch& batch : state_.batches) {
      const std::size_t a = batch.a, b = batch.b;
      projectBatch(&x.x[a], &x.y[a], &x.z[a], &w[a], &x.x[b], &x.y[b], &x.z[b], &w[b], &multiplier_[batch.first],
                   batch.rest, batch.two_sided ? INFINITY : 0.0, alpha_, batch.count);
    }
  }

  std::vector<double> multiplier_;  // lambda, a link each
  double alpha_ = 0.0;              // [1/kg]
};

}  // namespace

std::unique_ptr<Contestant> makeXpbd(const ClothStart& start, const PositionSettings& settings) {
  return std::make_unique<Xpbd>(start, settings);
}

}  // namespace curtain_bench
