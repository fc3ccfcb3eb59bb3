// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/closed_frames.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cloth/wide.h"

namespace curtain {
namespace {

// Excess over the start, in weight times height, from which substeps are found too long. Energies of single frames
// waver by (h omega)^2 / 8 of what moves, 4e-3 at one substep (modes of 20 / s, 0.3 of it moves); whips collect 0.2.
constexpr double kTooMuch = 1e-2;
constexpr int kEnoughSubsteps = 8;

// Not for cloth without pins: scaling velocities would change its momentum.
bool canClose(const Motion& motion) {
  const Method method = motion.scene.solver.method;
  const auto& pinned = motion.pattern.pinned;
  return (method == Method::kAuto || method == Method::kLeapfrog || method == Method::kLeapfrog4) &&
         std::any_of(pinned.begin(), pinned.end(), [](auto is_pinned) { return is_pinned != 0; });
}

// Kinetic energy of the nodes that move freely, each faster by `more` [m/s], and potential energy of all. Each
// lane is summed by itself, so the bits do not depend on the register width.
CURTAIN_WIDE double energyOf(const ClothPattern& pattern, const ClothState& state, const Vec3& more,
                             const Vec3& gravity) noexcept {
  const ConstFieldView v(state.velocity, 0), p(state.position, 0);
  const double* const mass = pattern.mass.data();
  const double* const inverse_mass = pattern.inverse_mass.data();
  const double mx = more.x(), my = more.y(), mz = more.z(), gx = gravity.x(), gy = gravity.y(), gz = gravity.z();
  double sum[kLane] = {};
  for (std::size_t n = 0; n < pattern.grid.size(); n += kLane) {
#pragma omp simd
    for (std::size_t l = 0; l < kLane; ++l) {
      const std::size_t k = n + l;
      const double x = v.x[k] + mx, y = v.y[k] + my, z = v.z[k] + mz;
      const double kinetic = inverse_mass[k] > 0.0 ? 0.5 * (x * x + y * y + z * z) : 0.0;
      sum[l] += mass[k] * (kinetic - (gx * p.x[k] + gy * p.y[k] + gz * p.z[k]));
    }
  }
  return std::accumulate(sum, sum + kLane, 0.0);
}

}  // namespace

ClosedFrames::ClosedFrames(Motion& motion, StepControls& controls, bool chooses)
    : motion_(motion),
      controls_(controls),
      chooses_(chooses),
      wanted_(chooses && canClose(motion)),
      total_mass_(std::accumulate(motion.pattern.mass.begin(), motion.pattern.mass.end(), 0.0)) {}

void ClosedFrames::pinsChanged() noexcept { wanted_ = chooses_ && canClose(motion_); }

// Nothing adds or removes energy but the scheme, and the engine chooses the steps.
bool ClosedFrames::isClosed() const noexcept {
  const NodeForces& last = motion_.forces.last();
  const bool chooses = motion_.scene.solver.substeps == 0 || motion_.statistics.rejected > 0;
  return wanted_ && chooses && !motion_.driven() && last.weight_only && !last.has_damping &&
         motion_.pushing() == nullptr;
}

// Energy before the velocity projection, which bounds it from above (Motion::velocities()): nearly free, while the
// projection costs as much as a substep.
double ClosedFrames::energyWithoutLinks() const noexcept {
  const ClothState& state = motion_.state;
  const Vec3& gravity = motion_.scene.gravity;
  const Vec3 fall = state.velocity_age * gravity;
  double guided = 0.0;
  for (const std::size_t n : motion_.pattern.guided)
    guided += 0.5 * motion_.pattern.mass[n] * (state.velocity.at(n) + fall).squaredNorm();
  return guided + energyOf(motion_.pattern, state, fall, gravity) +
         motion_.step.elasticEnergy(*motion_.forces.last().force, state.position);
}

void ClosedFrames::endFrame() {
  EnergyAccount& account = motion_.step.account();
  if (!isClosed()) {
    if (account.isClosed()) controls_.main.askFor(1);
    account.leaveOpen();
    return;
  }
  const double too_much = kTooMuch * total_mass_ * motion_.scene.gravity.norm() * longestWarp(motion_.scene);
  if (account.isClosed() && account.excess(energyWithoutLinks()) <= too_much) return;
  const Energy now = motion_.energy();
  if (!(account.excess(now.kinetic + now.potential) > too_much)) return;
  controls_.main.askFor(std::min(kEnoughSubsteps, 2 * std::max(1, motion_.statistics.substeps_last)));
  account.removeExcess(now, motion_.state.velocity);
  motion_.forgetVelocities();
}

}  // namespace curtain
