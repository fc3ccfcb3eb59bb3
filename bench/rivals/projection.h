// SPDX-License-Identifier: BSD-3-Clause
//
// The loop that PBD and XPBD share, with what is solid; how links are projected is theirs.
#pragma once

#include <algorithm>
#include <cmath>

#include "bench/rivals/grid_state.h"
#include "bench/rivals/rivals.h"

namespace curtain_bench {

constexpr double kTinyDenominator = 1e-30;  // keeps links between two pins and coincident nodes finite

class ProjectionContestant : public Contestant {
 public:
  ProjectionContestant(const ClothStart& start, const PositionSettings& settings)
      : state_(start), settings_(settings), h_(start.frame_seconds / settings.substeps), solid_(start.solid) {
    previous_ = state_.position;
  }

  void frame() override {
    for (int s = 0; s < settings_.substeps; ++s) {
      predict();
      begin();
      for (int iteration = 0; iteration < settings_.iterations; ++iteration) {
        projectLinks();
        if (solid_.shape != Solid::Shape::kNone) keepOut();
      }
      deriveVelocities();
    }
  }

  void copyPositions(Points& out) const override { state_.copyOut(state_.position, out); }
  void copyVelocities(Points& out) const override { state_.copyOut(state_.velocity, out); }
  int substeps() const override { return settings_.substeps; }

 protected:
  /// Before the iterations of a substep.
  virtual void begin() {}
  virtual void projectLinks() = 0;

  GridState state_;
  PositionSettings settings_;
  double h_ = 0.0;  // [s]

 private:
  // Macklin, Mueller, Chentanez, Kim 2014, "Unified Particle Physics for Real-Time Applications", Sect. 6.1 and Eq.
  // (24): out of it along the normal, then against the way along it since the substep's start, as far as friction
  // times the depth.
  void keepOut() {
    const Solid::Place was = solid_.at(time_ - h_), is = solid_.at(time_);
    for (std::size_t n = 0; n < state_.count(); ++n) {
      if (state_.free[n] == 0.0) continue;
      double* const x[3] = {&state_.position.x[n], &state_.position.y[n], &state_.position.z[n]};
      Solid::Place normal{};
      const double depth = solid_.margin - solid_.distance(is, {*x[0], *x[1], *x[2]}, normal);
      if (!(depth > 0.0)) continue;
      const double from[3] = {previous_.x[n], previous_.y[n], previous_.z[n]};
      Solid::Place way{};
      double along = 0.0, square = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        *x[k] += depth * normal[k];
        way[k] = *x[k] - from[k] - (is[k] - was[k]);
        along += way[k] * normal[k];
      }
      for (std::size_t k = 0; k < 3; ++k) square += (way[k] - along * normal[k]) * (way[k] - along * normal[k]);
      const double share = std::min(1.0, solid_.friction * depth / (std::sqrt(square) + kTinyDenominator));
      for (std::size_t k = 0; k < 3; ++k) *x[k] -= share * (way[k] - along * normal[k]);
    }
  }

  void predict() {
    time_ += h_;
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
  const Solid solid_;
  double time_ = 0.0;  // [s], at the end of the substep
};

}  // namespace curtain_bench
