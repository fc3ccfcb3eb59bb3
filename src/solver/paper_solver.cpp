// SPDX-License-Identifier: BSD-3-Clause
#include "solver/paper_solver.h"

#include <algorithm>
#include <cmath>

#include "forces/air_damping.h"

namespace curtain {
namespace {

// The fastest node may go so many times the cloth's size in a substep; beyond that its path can't be searched for contact. Only
// forces beyond all measure reach it, on cloth that nothing holds.
constexpr double kMostSizes = 4.0;

// Unit vector along v. Two nodes in one place have none: any will do, and the same each time.
Vec3 directionOf(const Vec3& v) noexcept {
  const double length = v.norm();
  return length > 0.0 ? Vec3((1.0 / length) * v) : Vec3(-Vec3::UnitZ());
}

}  // namespace

PaperSolver::PaperSolver(const ClothPattern& pattern)
    : pattern_(pattern), most_way_(kMostSizes * (pattern.warp_coordinate.back() + pattern.weft_coordinate.back())) {
  for (int j = 0; j < pattern.grid.columns; ++j) addColumn(j);
  start_.assign(pattern.grid.size(), 0.0);
  rebuilt_ = start_;
}

// Chains of a column: up from its topmost pin, down from its lowest, half way from each of two pins in a row.
void PaperSolver::addColumn(int column) {
  const Grid& grid = pattern_.grid;
  const std::ptrdiff_t down = grid.stride;
  const auto add = [&](int row, std::ptrdiff_t step, int rods, bool loose) {
    if (rods > 0 || loose) chains_.push_back({grid.index(row, column), step, rods, loose});
  };
  int last = -1;  // pinned row
  for (int i = 0; i < grid.rows; ++i) {
    if (!pattern_.isPinned({i, column})) continue;
    pins_.push_back(grid.index(i, column));
    if (last < 0) {
      add(i, -down, i, false);
    } else if (i - last > 1) {
      const int upper = (i - last - 1 + 1) / 2;
      add(last, down, upper, false);
      add(i, -down, i - last - 1 - upper, false);
      between_.push_back(grid.index(last + upper + 1, column));
    }
    last = i;
  }
  add(std::max(last, 0), down, grid.rows - 1 - std::max(last, 0), last < 0);
}

// Of the frame that the tensions are taken in: the anchor of Sect. 3.1 is fixed, a loose chain goes with its own centre of mass.
Vec3 PaperSolver::accelerationOf(const Chain& chain, const NodeForces& forces) const noexcept {
  if (!chain.loose) return Vec3::Zero();
  Vec3 force = Vec3::Zero();
  double mass = 0.0;
  for (int k = 0; k <= chain.rods; ++k) {
    force += forces.force->at(chain.node(k));
    mass += pattern_.mass[chain.node(k)];
  }
  return force / mass;
}

// Cheng 2000, Sect. 3.1, steps (1)-(4) and (6) for one column: where the forces and the tensions of Eq. (5) take its nodes.
void PaperSolver::predict(const Chain& chain, const NodeForces& forces, double h, ClothState& state) const noexcept {
  const Vec3 frame = accelerationOf(chain, forces);
  Vec3 pull_from_below = Vec3::Zero();  // tension of the rod below on the node at hand [N]
  for (int k = chain.rods; k >= (chain.loose ? 0 : 1); --k) {
    const std::size_t node = chain.node(k);
    const double m = pattern_.mass[node];
    const double w = pattern_.inverse_mass[node];
    Vec3 sum = forces.force->at(node) + pull_from_below;
    if (k > 0) {
      // (2) The node above is the origin; n is the rod's direction, t the one it turns in.
      const std::size_t above = chain.node(k - 1);
      const Vec3 n = directionOf(start_.at(node) - start_.at(above));
      const Vec3 relative_velocity = state.velocity.at(node) - state.velocity.at(above);
      const Vec3 tangential = relative_velocity - relative_velocity.dot(n) * n;
      // (4) Eq. (6), omega l = dx^t/dt, and Eq. (5), f^n = m omega^2 l, towards the origin: the rod's tension is what of the
      // sum along n is left over. Along t and z the sum acts by itself, Eqs. (7) and (8).
      const double tension = (sum - m * frame).dot(n) + m * tangential.squaredNorm() / rodLength(chain, k);
      pull_from_below = tension * n;
      sum -= pull_from_below;
    }
    const double damping = forces.has_damping ? forces.damping[node] : 0.0;
    const DampedStep damped = dampedStep(damping, w, h);
    state.position.add(node, h * (damped.keep * state.velocity.at(node) + h * damped.gain * w * sum));
  }
}

// Moves two nodes together along the line between them, by `excess` in all [m]; apart where it is negative.
void PaperSolver::adjust(std::size_t a, std::size_t b, double excess, Field3& position) const noexcept {
  const double w_a = pattern_.inverse_mass[a];
  const double w_b = pattern_.inverse_mass[b];
  if (w_a + w_b <= 0.0) return;
  const Vec3 move = excess / (w_a + w_b) * directionOf(position.at(b) - position.at(a));
  position.add(a, w_a * move);
  position.add(b, -w_b * move);
}

// Cheng 2000, Sect. 3.2, Fig. 8: neighbours further apart than l are moved until they are l apart.
void PaperSolver::adjustRow(int row, Field3& position) const noexcept {
  const Grid& grid = pattern_.grid;
  for (int j = grid.closed ? 0 : 1; j < grid.columns; ++j) {
    const std::size_t right = grid.index(row, j);
    const std::size_t left = grid.index(row, j > 0 ? j - 1 : grid.columns - 1);
    const double rest = pattern_.weft_rest[right];
    const double square = (position.at(right) - position.at(left)).squaredNorm();
    if (square > rest * rest) adjust(left, right, std::sqrt(square) - rest, position);
  }
}

void PaperSolver::adjustBetweenPins(Field3& position) const noexcept {
  for (const std::size_t lower : between_) {
    const std::size_t upper = lower - static_cast<std::size_t>(pattern_.grid.stride);
    adjust(upper, lower, (position.at(lower) - position.at(upper)).norm() - pattern_.warp_rest[lower], position);
  }
}

// Cheng 2000, Sect. 3.1, step (5), from the top: x_i = x_(i-1) + l R(omega dt) n.
void PaperSolver::rebuild(const Chain& chain, double h, ClothState& state) const noexcept {
  Field3& position = state.position;
  if (chain.loose) state.velocity.set(chain.anchor, (position.at(chain.anchor) - start_.at(chain.anchor)) / h);
  Vec3 moved = Vec3::Zero();  // [kg m]
  double mass = pattern_.mass[chain.anchor];
  for (int k = 1; k <= chain.rods; ++k) {
    const std::size_t node = chain.node(k);
    const std::size_t above = chain.node(k - 1);
    const Vec3 predicted = position.at(node);
    const Vec3 place = position.at(above) + rodLength(chain, k) * directionOf(predicted - position.at(above));
    const Vec3 impulse = pattern_.mass[node] * (place - predicted);  // of the rod, times h
    position.set(node, place);
    state.velocity.set(node, (place - start_.at(node)) / h);
    // Mueller 2012, Eq. (9), s = 1 and for nodes of different mass. With s = 0.95 the swing's error no longer goes down with the
    // step, below 0.8 its energy grows.
    if (k > 1 || chain.loose) state.velocity.add(above, -pattern_.inverse_mass[above] / h * impulse);
    moved += impulse;
    mass += pattern_.mass[node];
  }
  if (!chain.loose) return;
  // Rods move no centre of mass.
  for (int k = 0; k <= chain.rods; ++k) position.add(chain.node(k), -moved / mass);
}

// Mean over the pins, or, of a cloth without any, of all its mass: what the cloth moves with as a whole.
Vec3 PaperSolver::drift(const Field3& value) const noexcept {
  Vec3 sum = Vec3::Zero();
  double weight = 0.0;
  for (const std::size_t pin : pins_) sum += value.at(pin);
  if (!pins_.empty()) return sum / static_cast<double>(pins_.size());
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    sum += pattern_.mass[n] * value.at(n);
    weight += pattern_.mass[n];
  }
  return sum / weight;
}

// Of the motion relative to what holds the cloth [J].
double PaperSolver::kineticEnergy(const Field3& velocity) const noexcept {
  const Vec3 mean = drift(velocity);
  double twice = 0.0;
  for (const Chain& chain : chains_) {
    const Vec3 carried = chain.loose ? mean : velocity.at(chain.anchor);
    for (int k = chain.loose ? 0 : 1; k <= chain.rods; ++k) {
      twice += pattern_.mass[chain.node(k)] * (velocity.at(chain.node(k)) - carried).squaredNorm();
    }
  }
  return 0.5 * twice;
}

// Rods and wefts do no work: relative to the pins there is no more kinetic energy than before and what the forces did on the way.
// What is above that is taken out of all velocities alike. So weight alone never makes a hanging cloth's energy grow above both what it was
// and its potential energy, whatever the step.
void PaperSolver::boundEnergy(const NodeForces& forces, double before, ClothState& state) const noexcept {
  const Vec3 mean_move = drift(state.position) - drift(start_);
  double work = 0.0;
  for (const Chain& chain : chains_) {
    const Vec3 carried = chain.loose ? mean_move : Vec3(state.position.at(chain.anchor) - start_.at(chain.anchor));
    for (int k = chain.loose ? 0 : 1; k <= chain.rods; ++k) {
      const std::size_t node = chain.node(k);
      work += forces.force->at(node).dot(state.position.at(node) - start_.at(node) - carried);
    }
  }
  const double after = kineticEnergy(state.velocity);
  const double most = std::max(0.0, before + work);
  if (after <= most) return;
  const double share = std::sqrt(most / after);
  const Vec3 mean = drift(state.velocity);
  for (const Chain& chain : chains_) {
    const Vec3 carried = chain.loose ? mean : state.velocity.at(chain.anchor);
    for (int k = chain.loose ? 0 : 1; k <= chain.rods; ++k) {
      const std::size_t node = chain.node(k);
      state.velocity.set(node, carried + share * (state.velocity.at(node) - carried));
    }
  }
}

// Where the rebuilt cloth would go through something, contact holds its nodes; rods give way there.
void PaperSolver::holdBack(ContactFinder& finder, double h, ClothState& state) noexcept {
  if (finder.verify(start_, state.position, false) == ContactFinder::Verdict::kClear) return;
  rebuilt_ = state.position;
  finder.hold(start_, state.position);
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (pattern_.inverse_mass[n] > 0.0) state.velocity.add(n, (state.position.at(n) - rebuilt_.at(n)) / h);
  }
}

// Nothing that is pushed on comes nearer.
void PaperSolver::slowDown(const Contacts& contacts, Field3& velocity) const noexcept {
  for (const Contact& contact : contacts) {
    if (!contact.pushes()) continue;
    const double approach = contact.normal.dot(contact.point(velocity) - contact.surface_velocity);
    if (approach < 0.0) contact.move(pattern_.inverse_mass, -approach / contact.mobility * contact.normal, velocity);
  }
}

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
  const double energy = kineticEnergy(state.velocity);
  for (const std::size_t pin : pins_) state.position.add(pin, h * state.velocity.at(pin));
  for (const Chain& chain : chains_) predict(chain, forces, h, state);
  clock.lap(Stage::kWarp);
  for (int i = 0; i < pattern_.grid.rows; ++i) adjustRow(i, state.position);
  adjustBetweenPins(state.position);
  clock.lap(Stage::kWeft);
  Contacts* const contacts = finder != nullptr ? finder->begin(start_, state.position, h) : nullptr;
  if (contacts != nullptr) {
    beginContacts(pattern_.inverse_mass, 0.0, 0, *contacts, state.position);
    projectContacts(pattern_.inverse_mass, *contacts, state.position);
  }
  clock.lap(Stage::kContact);
  for (const Chain& chain : chains_) rebuild(chain, h, state);
  clock.lap(Stage::kWarp);
  if (contacts != nullptr) holdBack(*finder, h, state);
  boundEnergy(forces, energy, state);
  if (contacts != nullptr) slowDown(*contacts, state.velocity);
  const bool sound = this->sound(state, h);
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
