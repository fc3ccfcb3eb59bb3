// SPDX-License-Identifier: BSD-3-Clause
//
// Mass-spring cloth, the classical Runge-Kutta method of order 4 (Kutta 1901): stable for dt * omega_max < 2 sqrt(2).
#include <cmath>

#include "bench/rivals/rivals.h"
#include "bench/rivals/spring_forces.h"

namespace curtain_bench {
namespace {

// to = base + factor * slope, for pinned nodes too: their slopes are zero.
void combine(const std::vector<double>& base, const std::vector<double>& slope, double factor,
             std::vector<double>& to) {
  const double* const b = base.data();
  const double* const s = slope.data();
  double* const t = to.data();
#pragma omp simd
  for (std::size_t n = 0; n < base.size(); ++n) t[n] = b[n] + factor * s[n];
}

void combine(const Triple& base, const Triple& slope, double factor, Triple& to) {
  combine(base.x, slope.x, factor, to.x);
  combine(base.y, slope.y, factor, to.y);
  combine(base.z, slope.z, factor, to.z);
}

class RungeKutta : public Contestant {
 public:
  RungeKutta(const ClothStart& start, const ExplicitSettings& settings)
      : state_(start), substeps_(settings.substeps), h_(start.frame_seconds / settings.substeps) {
    stiffness_ = state_.min_free_mass * std::pow(0.5 * settings.limit / h_, 2);
    dashpot_ = settings.dashpot * std::sqrt(stiffness_ * state_.min_free_mass);
    for (Triple* triple : {&stage_x_, &stage_v_, &sum_x_, &sum_v_, &slope_v_}) triple->assign(state_.count(), 0.0);
  }

  void frame() override {
    for (int s = 0; s < substeps_; ++s) step();
  }

  void copyPositions(Points& out) const override { state_.copyOut(state_.position, out); }
  void copyVelocities(Points& out) const override { state_.copyOut(state_.velocity, out); }
  double elasticEnergy() const override { return springEnergy(state_, stiffness_); }
  int substeps() const override { return substeps_; }

 private:
  // x' = v, v' = f(x, v) / m: four slopes, weights 1 2 2 1 / 6.
  void step() {
    constexpr double kWeight[4] = {1.0 / 6.0, 2.0 / 6.0, 2.0 / 6.0, 1.0 / 6.0};
    constexpr double kPlace[3] = {0.5, 0.5, 1.0};
    stage_x_ = state_.position;
    stage_v_ = state_.velocity;
    sum_x_ = state_.position;
    sum_v_ = state_.velocity;
    for (int stage = 0; stage < 4; ++stage) {
      accelerations();
      combine(sum_x_, stage_v_, h_ * kWeight[stage], sum_x_);
      combine(sum_v_, slope_v_, h_ * kWeight[stage], sum_v_);
      if (stage == 3) break;
      combine(state_.position, stage_v_, h_ * kPlace[stage], stage_x_);
      combine(state_.velocity, slope_v_, h_ * kPlace[stage], stage_v_);
    }
    std::swap(state_.position, sum_x_);
    std::swap(state_.velocity, sum_v_);
  }

  void accelerations() {
    springForces(state_, stage_x_, stage_v_, stiffness_, dashpot_, slope_v_);
#pragma omp simd
    for (std::size_t n = 0; n < state_.count(); ++n) {
      const double w = state_.inverse_mass[n], c = state_.damping;
      slope_v_.x[n] = w * slope_v_.x[n] - c * stage_v_.x[n];
      slope_v_.y[n] = w * slope_v_.y[n] - c * stage_v_.y[n];
      slope_v_.z[n] = w * slope_v_.z[n] - c * stage_v_.z[n];
    }
  }

  GridState state_;
  Triple stage_x_, stage_v_, sum_x_, sum_v_, slope_v_;
  int substeps_ = 1;
  double h_ = 0.0;
  double stiffness_ = 0.0;
  double dashpot_ = 0.0;
};

}  // namespace

std::unique_ptr<Contestant> makeRungeKutta(const ClothStart& start, const ExplicitSettings& settings) {
  return std::make_unique<RungeKutta>(start, settings);
}

}  // namespace curtain_bench
