// SPDX-License-Identifier: BSD-3-Clause
//
// Mass-spring cloth, symplectic Euler: v += h f(x) / m, x += h v. The first kick is half a step, which makes it the
// leapfrog (Hairer, Lubich, Wanner 2003, "Geometric numerical integration illustrated by the Stoermer-Verlet method"):
// second order at the same price.
#include <cmath>

#include "bench/rivals/rivals.h"
#include "bench/rivals/spring_forces.h"

namespace curtain_bench {
namespace {

class SymplecticEuler : public Contestant {
 public:
  SymplecticEuler(const ClothStart& start, const ExplicitSettings& settings)
      : state_(start), substeps_(settings.substeps), h_(start.frame_seconds / settings.substeps) {
    // omega_max = 2 sqrt(k / m), the fastest mode of a chain of equal masses.
    stiffness_ = state_.min_free_mass * std::pow(0.5 * settings.limit / h_, 2);
    dashpot_ = settings.dashpot * std::sqrt(stiffness_ * state_.min_free_mass);
    force_.assign(state_.count(), 0.0);
  }

  void frame() override {
    for (int s = 0; s < substeps_; ++s) {
      springForces(state_, state_.position, state_.velocity, stiffness_, dashpot_, force_);
      kick(begun_ ? h_ : 0.5 * h_);
      begun_ = true;
      drift();
    }
  }

  void copyPositions(Points& out) const override { state_.copyOut(state_.position, out); }

  // Velocities live half a step behind the positions: brought to the same instant by half a kick.
  void copyVelocities(Points& out) const override {
    if (!begun_) return state_.copyOut(state_.velocity, out);
    SymplecticEuler now(*this);
    springForces(now.state_, now.state_.position, now.state_.velocity, stiffness_, dashpot_, now.force_);
    now.kick(0.5 * h_);
    now.state_.copyOut(now.state_.velocity, out);
  }

  double elasticEnergy() const override { return springEnergy(state_, stiffness_); }
  int substeps() const override { return substeps_; }

 private:
  void kick(double h) {
    const double keep = std::exp(-state_.damping * h);
#pragma omp simd
    for (std::size_t n = 0; n < state_.count(); ++n) {
      const double w = h * state_.inverse_mass[n];
      state_.velocity.x[n] = keep * state_.velocity.x[n] + w * force_.x[n];
      state_.velocity.y[n] = keep * state_.velocity.y[n] + w * force_.y[n];
      state_.velocity.z[n] = keep * state_.velocity.z[n] + w * force_.z[n];
    }
  }

  void drift() {
#pragma omp simd
    for (std::size_t n = 0; n < state_.count(); ++n) {
      state_.position.x[n] += h_ * state_.velocity.x[n];
      state_.position.y[n] += h_ * state_.velocity.y[n];
      state_.position.z[n] += h_ * state_.velocity.z[n];
    }
  }

  GridState state_;
  Triple force_;  // [N]
  int substeps_ = 1;
  double h_ = 0.0;          // [s]
  double stiffness_ = 0.0;  // [N/m]
  double dashpot_ = 0.0;    // [N s/m]
  bool begun_ = false;
};

}  // namespace

std::unique_ptr<Contestant> makeSymplecticEuler(const ClothStart& start, const ExplicitSettings& settings) {
  return std::make_unique<SymplecticEuler>(start, settings);
}

}  // namespace curtain_bench
