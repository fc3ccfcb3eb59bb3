// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth that only its weight moves, and nothing damps, has no more energy than it had. Leapfrog keeps that as long as its substeps
// are all alike; where their lengths follow the tensions, as automatic ones do, every change sets the energy a little off, and a
// whip that makes it change at the same phases collects that: 0.2 m g H in 10 s of a sheet let go at 70 degrees. What is too much
// is taken out of the velocities at the frame's end.
#include <algorithm>
#include <cmath>

#include "simulator/simulator_impl.h"

namespace curtain {
namespace {

// What may be above before substeps are found too long, over what the cloth's weight does over its height: energies of single frames
// waver by (h omega)^2 / 8 of what moves, 4e-3 at one substep (modes of 20 / s, 0.3 of it moves); whips collect 0.2.
constexpr double kTooMuch = 1e-2;
constexpr int kEnoughSubsteps = 8;

}  // namespace

Energy Simulator::Impl::energy() {
  const Field3& velocity = currentVelocities();
  Energy energy;
  for (std::size_t n = 0; n < pattern.grid.size(); ++n) {
    energy.kinetic += 0.5 * pattern.mass[n] * velocity.at(n).squaredNorm();
    energy.potential -= pattern.mass[n] * scene.gravity.dot(state.position.at(n));
  }
  return energy;
}

// Nothing puts energy in or takes it out but the scheme, which is free to choose its steps. A cloth that nothing holds would lose
// of its momentum.
bool Simulator::Impl::isClosed() const noexcept {
  const SolverParams& solver = scene.solver;
  const bool leaps = solver.method == Method::kAuto || solver.method == Method::kLeapfrog || solver.method == Method::kLeapfrog4;
  const NodeForces& last = forces.last();
  const bool chooses = solver.substeps == 0 || statistics.rejected > 0;
  return leaps && chooses && estimate == nullptr && has_pins && pin_moves.empty() && last.weight_only &&
         !last.has_damping && !(contact.any() && anyPushes(contact.contacts()));
}

// The energy before links take out of the velocities what is theirs (currentVelocities() bounds it by this): a look that costs
// next to nothing, where the velocities themselves cost as much as a substep.
double Simulator::Impl::energyWithoutLinks() const noexcept {
  const double age = state.velocity_age;
  const Vec3 fall = age * scene.gravity;
  double kinetic = 0.0, potential = 0.0;
  for (std::size_t n = 0; n < pattern.grid.size(); ++n) {
    const double m = pattern.mass[n];
    if (pattern.pinned[n] == 0) kinetic += 0.5 * m * (state.velocity.at(n) + fall).squaredNorm();
    potential -= m * scene.gravity.dot(state.position.at(n));
  }
  return kinetic + potential;
}

// Before a frame and after it.
void Simulator::Impl::keepEnergy() {
  if (!isClosed()) {
    if (most_energy && estimate == nullptr) control.askFor(1);
    most_energy.reset();
    return;
  }
  const double too_much = kTooMuch * total_mass * scene.gravity.norm() * scene.cloth.height;
  if (most_energy && energyWithoutLinks() <= *most_energy + too_much) return;
  const Energy now = energy();
  if (!most_energy) most_energy = now.kinetic + now.potential;
  if (!(now.kinetic + now.potential - *most_energy > too_much)) return;
  control.askFor(std::min(kEnoughSubsteps, 2 * std::max(1, statistics.substeps_last)));
  const double share = std::sqrt(std::max(0.0, (*most_energy - now.potential) / now.kinetic));
  if (!std::isfinite(share)) return;
  for (std::size_t n = 0; n < pattern.grid.size(); ++n) {
    if (pattern.pinned[n] == 0) state.velocity.set(n, share * state.velocity.at(n));
  }
  velocities_fresh = false;
}

}  // namespace curtain
