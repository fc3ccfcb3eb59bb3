// SPDX-License-Identifier: BSD-3-Clause
//
// Implicit mass-spring cloth, Baraff, Witkin 1998, "Large Steps in Cloth Simulation": backward Euler linearised once,
//   (M - h^2 df/dx) dv = h (f + h df/dx v)                                                         Eq. (6)
// by conjugate gradients with the inverse diagonal blocks as preconditioner and pinned nodes filtered out (Sect. 5).
#include <cmath>
#include <utility>

#include "bench/rivals/rivals.h"
#include "bench/rivals/spring_forces.h"
#include "bench/rivals/spring_matrix.h"

namespace curtain_bench {
namespace {

double dot(const Triple& a, const Triple& b) {
  double sum = 0.0;
#pragma omp simd reduction(+ : sum)
  for (std::size_t n = 0; n < a.x.size(); ++n) sum += a.x[n] * b.x[n] + a.y[n] * b.y[n] + a.z[n] * b.z[n];
  return sum;
}

// to = a + factor * b
void combine(const Triple& a, double factor, const Triple& b, Triple& to) {
#pragma omp simd
  for (std::size_t n = 0; n < a.x.size(); ++n) {
    to.x[n] = a.x[n] + factor * b.x[n];
    to.y[n] = a.y[n] + factor * b.y[n];
    to.z[n] = a.z[n] + factor * b.z[n];
  }
}

class BaraffWitkin : public Contestant {
 public:
  BaraffWitkin(const ClothStart& start, const ImplicitSettings& settings)
      : state_(start), settings_(settings), h_(start.frame_seconds / settings.substeps), matrix_(state_) {
    for (Triple* triple : {&force_, &right_, &change_, &residual_, &direction_, &product_, &scaled_}) {
      triple->assign(state_.count(), 0.0);
    }
  }

  void frame() override {
    for (int s = 0; s < settings_.substeps; ++s) step();
  }

  void copyPositions(Points& out) const override { state_.copyOut(state_.position, out); }
  void copyVelocities(Points& out) const override { state_.copyOut(state_.velocity, out); }
  double elasticEnergy() const override { return springEnergy(state_, settings_.stiffness); }
  int substeps() const override { return settings_.substeps; }

 private:
  void step() {
    springForces(state_, state_.position, state_.velocity, settings_.stiffness, 0.0, force_);
    matrix_.linearise(state_, settings_.stiffness, h_);
    // h^2 df/dx v is minus the matrix' link part on v.
    matrix_.multiplyLinks(state_, state_.velocity, product_);
#pragma omp simd
    for (std::size_t n = 0; n < state_.count(); ++n) {
      right_.x[n] = state_.free[n] * (h_ * force_.x[n] - product_.x[n]);
      right_.y[n] = state_.free[n] * (h_ * force_.y[n] - product_.y[n]);
      right_.z[n] = state_.free[n] * (h_ * force_.z[n] - product_.z[n]);
    }
    solve();
    const double keep = std::exp(-state_.damping * h_);
#pragma omp simd
    for (std::size_t n = 0; n < state_.count(); ++n) {
      state_.velocity.x[n] = keep * (state_.velocity.x[n] + change_.x[n]);
      state_.velocity.y[n] = keep * (state_.velocity.y[n] + change_.y[n]);
      state_.velocity.z[n] = keep * (state_.velocity.z[n] + change_.z[n]);
    }
    combine(state_.position, h_, state_.velocity, state_.position);
  }

  // Conjugate gradients for the change of velocity, from that of the last step: it changes little.
  void solve() {
    matrix_.precondition(state_, right_, scaled_);
    const double enough = settings_.tolerance * settings_.tolerance * dot(right_, scaled_);
    matrix_.multiply(state_, change_, product_);
    combine(right_, -1.0, product_, residual_);
    matrix_.precondition(state_, residual_, direction_);
    double size = dot(residual_, direction_);
    for (int iteration = 0; iteration < settings_.iterations && size > enough; ++iteration) {
      matrix_.multiply(state_, direction_, product_);
      const double along = size / dot(direction_, product_);
      combine(change_, along, direction_, change_);
      combine(residual_, -along, product_, residual_);
      matrix_.precondition(state_, residual_, scaled_);
      const double next = dot(residual_, scaled_);
      combine(scaled_, next / size, direction_, direction_);
      size = next;
    }
  }

  GridState state_;
  ImplicitSettings settings_;
  double h_ = 0.0;  // [s]
  SpringMatrix matrix_;
  Triple force_, right_, change_, residual_, direction_, product_, scaled_;
};

}  // namespace

std::unique_ptr<Contestant> makeBaraffWitkin(const ClothStart& start, const ImplicitSettings& settings) {
  return std::make_unique<BaraffWitkin>(start, settings);
}

}  // namespace curtain_bench
