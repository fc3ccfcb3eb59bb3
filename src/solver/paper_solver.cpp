// SPDX-License-Identifier: BSD-3-Clause
#include "solver/paper_solver.h"

#include <algorithm>
#include <cmath>

#include "forces/air_damping.h"

namespace curtain {
namespace {

// The fastest node may go so many times the cloth's size in a substep.
constexpr double kMostSizes = 4.0;

}  // namespace

PaperSolver::PaperSolver(const ClothPattern& pattern)
    : pattern_(pattern), most_way_(kMostSizes * (pattern.warp_coordinate.back() + pattern.weft_coordinate.back())) {
  start_.assign(pattern.grid.size(), 0.0);
}

// Cheng 2000, Sect. 3.1, steps (1)-(6) for one column.
void PaperSolver::moveColumn(int column, const NodeForces& forces, double h, ClothState& state) const noexcept {
  const Grid& grid = pattern_.grid;
  Vec3 pull_from_below = Vec3::Zero();  // tension of the rod below on the node at hand [N]
  for (int i = grid.rows - 1; i >= 0; --i) {
    const std::size_t node = grid.index(i, column);
    const double w = pattern_.inverse_mass[node];
    const double m = pattern_.mass[node];
    const double c = forces.has_damping ? forces.damping[node] : 0.0;
    const DampedStep damped = dampedStep(c, w, h);
    Vec3 acceleration = (forces.force->at(node) + pull_from_below) * w;
    if (i > 0) {
      // (2) the node above is the origin; the rod's direction is the local normal axis n, and the local x-y plane is
      // the one the rod turns in, so that Eq. (6) sees the whole of the tangential motion.
      const std::size_t above = grid.index(i - 1, column);
      const Vec3 rod = state.position.at(node) - state.position.at(above);
      const double length = rod.norm();
      const Vec3 n = length > 0.0 ? Vec3(rod / length) : Vec3(-Vec3::UnitZ());
      const Vec3 relative_velocity = state.velocity.at(node) - state.velocity.at(above);
      const Vec3 tangential = relative_velocity - relative_velocity.dot(n) * n;
      // (3) the sum of forces, along the rod and across it.
      const Vec3 sum = forces.force->at(node) + pull_from_below;
      const double along = sum.dot(n);
      // (4) Eq. (6): omega l = dx^t/dt; Eq. (5): f^n = m omega^2 l, towards the origin.
      const double lever = length > 0.0 ? length : pattern_.warp_rest[node];  // one that has drifted to nothing
      const double omega = tangential.norm() / lever;
      const double centripetal = m * omega * omega * lever;
      // Eqs. (7)(8) and the same along t: acceleration = force / mass; the rod takes up what is left along n.
      acceleration = (sum - (along + centripetal) * n) * w;
      pull_from_below = (along + centripetal) * n;
    }
    if (w == 0.0) continue;
    const Vec3 velocity = damped.keep * state.velocity.at(node) + h * damped.gain * acceleration;
    state.velocity.set(node, velocity);
    state.position.add(node, h * velocity);
  }
}

// Cheng 2000, Sect. 3.2, Fig. 8: neighbours further apart than l are moved until they are l apart.
void PaperSolver::adjustRow(int row, ClothState& state) const noexcept {
  const Grid& grid = pattern_.grid;
  for (int j = grid.closed ? 0 : 1; j < grid.columns; ++j) {
    const std::size_t right = grid.index(row, j);
    const std::size_t left = grid.index(row, j > 0 ? j - 1 : grid.columns - 1);
    const double w_left = pattern_.inverse_mass[left];
    const double w_right = pattern_.inverse_mass[right];
    const double w = w_left + w_right;
    const Vec3 link = state.position.at(right) - state.position.at(left);
    const double length = link.norm();
    const double rest = pattern_.weft_rest[right];
    if (length <= rest || w <= 0.0) continue;
    const Vec3 direction = link / length;
    const Vec3 move = (length - rest) / w * direction;
    state.position.add(left, w_left * move);
    state.position.add(right, -w_right * move);
    const double parting = (state.velocity.at(right) - state.velocity.at(left)).dot(direction);
    if (parting <= 0.0) continue;
    state.velocity.add(left, w_left * (parting / w) * direction);
    state.velocity.add(right, -w_right * (parting / w) * direction);
  }
}

// Contacts one by one, positions and then velocities; what still goes through something is held.
void PaperSolver::touch(ContactFinder* finder, double h, ClothState& state) noexcept {
  if (finder == nullptr) return;
  Contacts& contacts = finder->begin(start_, state.position, h);
  beginContacts(pattern_.inverse_mass, 0.0, 0, contacts, state.position);
  projectContacts(pattern_.inverse_mass, contacts, state.position);
  if (finder->verify(start_, state.position, false) != ContactFinder::Verdict::kClear) finder->hold(start_, state.position);
  for (const Contact& contact : contacts) {
    if (!contact.pushes()) continue;
    const double approach = contact.normal.dot(contact.point(state.velocity) - contact.surface_velocity);
    if (approach < 0.0) contact.move(pattern_.inverse_mass, -approach / contact.mobility * contact.normal, state.velocity);
  }
}

// As printed nothing bounds the motion: it blows up. A node so fast leaves all cloth behind in one substep, its next one would be
// beyond numbers, and its way beyond what can be looked through for contact.
bool PaperSolver::sound(const ClothState& state, double h) const noexcept {
  const double fastest = most_way_ / h;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (pattern_.inverse_mass[n] <= 0.0) continue;
    if (!(state.velocity.at(n).squaredNorm() <= fastest * fastest) || !state.position.at(n).allFinite()) return false;
  }
  return true;
}

SubstepOutcome PaperSolver::substep(const NodeForces& forces, double h, ContactFinder* finder,
                                    ClothState& state, StageClock& clock) noexcept {
  start_ = state.position;
  for (int j = 0; j < pattern_.grid.columns; ++j) moveColumn(j, forces, h, state);
  clock.lap(Stage::kWarp);
  for (int i = 0; i < pattern_.grid.rows; ++i) adjustRow(i, state);
  clock.lap(Stage::kWeft);
  bool sound = this->sound(state, h);
  if (sound) touch(finder, h, state);
  sound = sound && this->sound(state, h);
  if (!sound) state.position = start_;
  clock.lap(Stage::kContact);
  state.velocity_age = 0.0;
  SubstepOutcome outcome;
  outcome.accepted = outcome.settled = sound;
  outcome.sweeps = 1;
  outcome.scale = h * h;
  outcome.kick = h;
  return outcome;
}

}  // namespace curtain
