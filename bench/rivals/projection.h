// SPDX-License-Identifier: BSD-3-Clause
//
// The loop that PBD and XPBD share; how links are projected is theirs.
#pragma once

#include <cmath>

#include "bench/rivals/grid_state.h"
#include "bench/rivals/rivals.h"

namespace curtain_bench {

constexpr double kTinyDenominator = 1e-30;  // keeps links between two pins and coincident nodes finite

class ProjectionContestant : public Contestant {
 public:
  ProjectionContestant(const ClothStart& start, const PositionSettings& settings)
      : state_(start), settings_(settings), h_(start.frame_seconds / settings.substeps) {
    previous_ = state_.position;
  }

  void frame() override {
    for (int s = 0; s < settings_.substeps; ++s) {
      predict();
      project();
      deriveVelocities();
    }
  }

  void copyPositions(Points& out) const override { state_.copyOut(state_.position, out); }
  void copyVelocities(Points& out) const override { state_.copyOut(state_.velocity, out); }
  int substeps() const override { return settings_.substeps; }

 protected:
  virtual void project() = 0;

  GridState state_;
  PositionSettings settings_;
  double h_ = 0.0;  // [s]

 private:
  void predict() {
    const double keep = std::exp(-state_.damping * h_);
#pragma omp simd
    for (std::size_t n = 0; n < state_.count(); ++n) {
      const double h = h_ * state_.free[n];
      previous_.x[n] = state_.position.x[n];
      previous_.y[n] = state_.position.y[n];
      previous_.z[n] = state_.position.z[n];
      state_.position.x[n] += h * (keep * state_.velocity.x[n] + h_ * state_.gravity[0]);
      state_.position.y[n] += h * (keep * state_.velocity.y[n] + h_ * state_.gravity[1]);
      state_.position.z[n] += h * (keep * state_.velocity.z[n] + h_ * state_.gravity[2]);
    }
  }

  void deriveVelocities() {
    const double per_h = 1.0 / h_;
#pragma omp simd
    for (std::size_t n = 0; n < state_.count(); ++n) {
      state_.velocity.x[n] = per_h * (state_.position.x[n] - previous_.x[n]);
      state_.velocity.y[n] = per_h * (state_.position.y[n] - previous_.y[n]);
      state_.velocity.z[n] = per_h * (state_.position.z[n] - previous_.z[n]);
    }
  }

  Triple previous_;
};

}  // namespace curtain_bench
