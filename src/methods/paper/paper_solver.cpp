// SPDX-License-Identifier: BSD-3-Clause
#include "methods/paper/paper_solver.h"

#include <algorithm>
#include <cmath>

namespace curtain {
namespace {

// Largest displacement of a node in a substep, over the cloth's size: contact can't search longer paths. Only extreme
// forces on cloth without pins reach it.
constexpr double kMaxSizes = 4.0;

// Unit vector along v. For coincident nodes any will do, but always the same.
Vec3 directionOf(const Vec3& v) noexcept {
  const double length = v.norm();
  return length > 0.0 ? Vec3(v / length) : Vec3(-Vec3::UnitZ());
}

double sizeOf(const ClothPattern& pattern) {
  return *std::max_element(pattern.warp_coordinate.begin(), pattern.warp_coordinate.end()) +
         pattern.weft_coordinate.back();
}

}  // namespace

PaperSolver::PaperSolver(const ClothPattern& pattern) : pattern_(pattern), max_way_(kMaxSizes * sizeOf(pattern)) {
  const std::size_t nodes = pattern.grid.nodeCount();  // room for what pins them within a step
  chains_.reserve(2 * nodes);
  pins_.reserve(nodes);
  between_.reserve(nodes);
  pinsChanged();
  start_.assign(pattern.grid.size(), 0.0);
  rebuilt_ = start_;
  taut_.assign(static_cast<std::size_t>(pattern.grid.columns), 0);
}

void PaperSolver::pinsChanged() {
  chains_.clear();
  pins_.clear();
  between_.clear();
  for (int j = 0; j < pattern_.grid.columns; ++j) addColumn(j);
}

// Chains of a column: up from its topmost pin, down from its lowest, half way between two pins.
void PaperSolver::addColumn(int column) {
  const Grid& grid = pattern_.grid;
  const std::ptrdiff_t down = grid.stride;
  const auto add = [&](int row, std::ptrdiff_t step, int rods, bool loose) {
    if (rods > 0 || loose) chains_.push_back({grid.index(row, column), step, rods, loose, 0.0});
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

// Acceleration of the frame that tensions are computed in. The anchor of Sect. 3.1 is fixed; a loose chain moves with
// its centre of mass.
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

// Cheng 2000, Sect. 3.1, steps (1)-(4) and (6) for one column: motion by the forces and the tensions of Eq. (5).
void PaperSolver::predict(const Chain& chain, const NodeForces& forces, double h, ClothState& state) const noexcept {
  const Vec3 frame = accelerationOf(chain, forces);
  Vec3 pull_from_below = Vec3::Zero();  // tension of the rod below on this node [N]
  for (int k = chain.rods; k >= chain.first(); --k) {
    const std::size_t node = chain.node(k);
    const double m = pattern_.mass[node];
    const double w = pattern_.inverse_mass[node];
    Vec3 sum = forces.force->at(node) + pull_from_below;
    if (k > 0) {
      // (2) The node above is the origin; n is the rod's direction, t the direction it turns in.
      const std::size_t above = chain.node(k - 1);
      const Vec3 n = directionOf(start_.at(node) - start_.at(above));
      const Vec3 relative_velocity = state.velocity.at(node) - state.velocity.at(above);
      const Vec3 tangential = relative_velocity - relative_velocity.dot(n) * n;
      // (4) Eq. (6), omega l = dx^t/dt, and Eq. (5), f^n = m omega^2 l towards the origin: the rod's tension balances
      // the rest of the sum along n. Along t and z the sum acts by itself, Eqs. (7) and (8).
      const double tension = (sum - m * frame).dot(n) + m * tangential.squaredNorm() / rodLength(chain, k);
      pull_from_below = tension * n;
      sum -= pull_from_below;
    }
    const double damping = forces.has_damping ? forces.damping[node] : 0.0;
    const DampedStep damped = dampedStep(damping, w, h);
    state.position.add(node, h * (damped.keep * state.velocity.at(node) + h * damped.gain * w * sum));
  }
}

// Moves two nodes together by `excess` in all [m] along the line between them; apart where it is negative.
void PaperSolver::adjust(std::size_t a, std::size_t b, double excess, Field3& position) noexcept {
  const double w_a = pattern_.inverse_mass[a];
  const double w_b = pattern_.inverse_mass[b];
  if (w_a + w_b <= 0.0) return;
  const Vec3 move = excess / (w_a + w_b) * directionOf(position.at(b) - position.at(a));
  position.add(a, w_a * move);
  position.add(b, -w_b * move);
  taut_[columnOf(a)] = taut_[columnOf(b)] = 1;
}

// Cheng 2000, Sect. 3.2, Fig. 8: neighbours further apart than l are moved to distance l.
void PaperSolver::adjustRow(int row, Field3& position) noexcept {
  const Grid& grid = pattern_.grid;
  for (int j = grid.closed ? 0 : 1; j < grid.columns; ++j) {
    if (!grid.hasLink(row, j)) continue;
    const std::size_t right = grid.index(row, j);
    const std::size_t left = grid.index(row, j > 0 ? j - 1 : grid.columns - 1);
    const double rest = pattern_.weft_rest[right];
    const double square = (position.at(right) - position.at(left)).squaredNorm();
    if (square > rest * rest) adjust(left, right, std::sqrt(square) - rest, position);
  }
}

void PaperSolver::adjustBetweenPins(Field3& position) noexcept {
  for (const std::size_t lower : between_) {
    const std::size_t upper = lower - static_cast<std::size_t>(pattern_.grid.stride);
    adjust(upper, lower, (position.at(lower) - position.at(upper)).norm() - pattern_.warp_rest[lower], position);
  }
}

// Cheng 2000, Sect. 3.1, step (5), from the top: x_i = x_(i-1) + l R(omega dt) n. Places are counted from the anchor
// until it is known where that ends, so that however far a step predicts a loose chain, its rods have the rounding of
// where it is.
void PaperSolver::rebuild(const Chain& chain, double h, ClothState& state) const noexcept {
  Field3& position = state.position;
  Vec3 anchor = position.at(chain.anchor);
  if (chain.loose) state.velocity.set(chain.anchor, (anchor - start_.at(chain.anchor)) / h);
  Vec3 moved = Vec3::Zero();  // [kg m]
  Vec3 from_anchor = Vec3::Zero();
  double mass = pattern_.mass[chain.anchor];
  for (int k = 1; k <= chain.rods; ++k) {
    const std::size_t node = chain.node(k);
    const std::size_t above = chain.node(k - 1);
    const Vec3 predicted = position.at(node);
    from_anchor += rodLength(chain, k) * directionOf(predicted - (anchor + from_anchor));
    position.set(node, from_anchor);
    const Vec3 place = anchor + from_anchor;
    const Vec3 impulse = pattern_.mass[node] * (place - predicted);  // of the rod, times h
    state.velocity.set(node, (place - start_.at(node)) / h);
    // Mueller 2012, Eq. (9), with s = 1 and nodes of different mass. With s = 0.95 the swing's error stops falling with
    // the step; below 0.8 its energy grows.
    if (k > 1 || chain.loose) state.velocity.add(above, -pattern_.inverse_mass[above] / h * impulse);
    moved += impulse;
    mass += pattern_.mass[node];
  }
  if (chain.loose) anchor -= moved / mass;  // rods do not move the centre of mass
  position.set(chain.anchor, anchor);
  for (int k = 1; k <= chain.rods; ++k) position.add(chain.node(k), anchor);
}

// Adds the mass-weighted sum over a chain, and its mass.
void PaperSolver::addMean(const Chain& chain, const Field3& value, Vec3& sum, double& mass) const noexcept {
  for (int k = chain.first(); k <= chain.rods; ++k) {
    sum += pattern_.mass[chain.node(k)] * value.at(chain.node(k));
    mass += pattern_.mass[chain.node(k)];
  }
}

// Common motion of the loose columns that wefts pull on: that of the pins, or without pins of their centre of mass.
Vec3 PaperSolver::commonMean(const Field3& value) const noexcept {
  Vec3 sum = Vec3::Zero();
  double mass = 0.0;
  for (const std::size_t pin : pins_) sum += value.at(pin);
  if (!pins_.empty()) return sum / static_cast<double>(pins_.size());
  for (const Chain& chain : chains_) {
    if (isTaut(chain)) addMean(chain, value, sum, mass);
  }
  return mass > 0.0 ? Vec3(sum / mass) : sum;
}

// Motion that a chain's energy is measured against: its pin's, or, where no weft pulls, its own centre of mass.
Vec3 PaperSolver::carrierOf(const Chain& chain, const Field3& value, const Vec3& common) const noexcept {
  if (!chain.loose) return value.at(chain.anchor);
  if (isTaut(chain)) return common;
  Vec3 sum = Vec3::Zero();
  double mass = 0.0;
  addMean(chain, value, sum, mass);
  return sum / mass;
}

// Relative to the carrier [J].
double PaperSolver::kineticEnergy(const Chain& chain, const Field3& velocity, const Vec3& carrier) const noexcept {
  double twice = 0.0;
  for (int k = chain.first(); k <= chain.rods; ++k) {
    twice += pattern_.mass[chain.node(k)] * (velocity.at(chain.node(k)) - carrier).squaredNorm();
  }
  return 0.5 * twice;
}

// To be called before velocities change, when it is known which columns wefts pull on.
void PaperSolver::keepEnergies(const Field3& velocity) noexcept {
  const Vec3 common = commonMean(velocity);
  for (Chain& chain : chains_) chain.max_energy = kineticEnergy(chain, velocity, carrierOf(chain, velocity, common));
}

// Rods and wefts do no work: relative to its carrier a column has at most its old kinetic energy plus the work of the
// forces; columns coupled by wefts exchange energy and share one bound. Excess is taken out of their velocities in
// proportion. So weight alone never raises the energy of cloth on fixed pins, whatever the step.
void PaperSolver::boundEnergy(const NodeForces& forces, ClothState& state) noexcept {
  const Vec3 common = commonMean(state.velocity);
  const Vec3 common_move = commonMean(state.position) - commonMean(start_);
  double most = 0.0, all = 0.0;  // of the columns that wefts pull on [J]
  for (Chain& chain : chains_) {
    const Vec3 move = carrierOf(chain, state.position, common_move) - carrierOf(chain, start_, Vec3::Zero());
    for (int k = chain.first(); k <= chain.rods; ++k) {
      const std::size_t n = chain.node(k);
      chain.max_energy += forces.force->at(n).dot(state.position.at(n) - start_.at(n) - move);
    }
    const Vec3 carrier = carrierOf(chain, state.velocity, common);
    const double energy = kineticEnergy(chain, state.velocity, carrier);
    if (isTaut(chain)) {
      most += chain.max_energy;
      all += energy;
    } else {
      slowDown(chain, chain.max_energy, energy, carrier, state.velocity);
    }
  }
  for (const Chain& chain : chains_) {
    if (isTaut(chain)) slowDown(chain, most, all, carrierOf(chain, state.velocity, common), state.velocity);
  }
}

void PaperSolver::slowDown(const Chain& chain, double most, double energy, const Vec3& carrier,
                           Field3& velocity) const noexcept {
  if (energy <= std::max(0.0, most)) return;
  const double share = std::sqrt(std::max(0.0, most) / energy);
  for (int k = chain.first(); k <= chain.rods; ++k) {
    const std::size_t node = chain.node(k);
    velocity.set(node, carrier + share * (velocity.at(node) - carrier));
  }
}

// Where the rebuilt cloth would cross something, contact moves its nodes once more and holds those that still cross;
// rods change their length there. False: something crosses all the same, or there is no room for more contacts.
bool PaperSolver::holdBack(ContactFinder& finder, Contacts& contacts, double h, ClothState& state) noexcept {
  const auto clear = [&] { return finder.verify(start_, state.position, false) == ContactFinder::Verdict::kClear; };
  if (clear()) return true;
  rebuilt_ = state.position;
  project(h, contacts, state.position);
  if (!clear()) {
    finder.hold(start_, state.position);
    if (!clear()) return false;
  }
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (pattern_.inverse_mass[n] > 0.0) state.velocity.add(n, (state.position.at(n) - rebuilt_.at(n)) / h);
  }
  return true;
}

void PaperSolver::project(double h, Contacts& contacts, Field3& position) const noexcept {
  beginContacts(pattern_.inverse_mass, h * h, 0.0, 0, contacts, position);
  projectContacts(pattern_.inverse_mass, contacts, position);
}

// Removes approaching normal velocities of pushing contacts.
void PaperSolver::stopApproach(const Contacts& contacts, Field3& velocity) const noexcept {
  for (const Contact& contact : contacts) {
    if (!contact.pushes()) continue;
    const double approach = contact.normal.dot(contact.point(velocity) - contact.surface_velocity);
    if (approach < 0.0) contact.move(pattern_.inverse_mass, -approach / contact.mobility * contact.normal, velocity);
  }
}

bool PaperSolver::sound(const ClothState& state, double h) const noexcept {
  const double fastest = max_way_ / h;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (pattern_.inverse_mass[n] <= 0.0) continue;
    if (!(state.velocity.at(n).squaredNorm() <= fastest * fastest) || !state.position.at(n).allFinite()) return false;
  }
  return true;
}

// The cloth stays where it was, at rest; pins go on in the next substep.
void PaperSolver::stop(ClothState& state) const noexcept {
  state.position = start_;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (pattern_.inverse_mass[n] > 0.0) state.velocity.set(n, Vec3::Zero());
  }
}

SubstepOutcome PaperSolver::substep(const NodeForces& forces, double h, ContactFinder* finder, ClothState& state,
                                    StageClock& clock) noexcept {
  start_ = state.position;
  std::fill(taut_.begin(), taut_.end(), 0);
  for (const std::size_t pin : pins_) state.position.add(pin, h * state.velocity.at(pin));
  for (const Chain& chain : chains_) predict(chain, forces, h, state);
  clock.lap(Stage::kWarp);
  for (int i = 0; i < pattern_.grid.rows; ++i) adjustRow(i, state.position);
  adjustBetweenPins(state.position);
  keepEnergies(state.velocity);
  clock.lap(Stage::kWeft);
  Contacts* const contacts =
      finder != nullptr ? &finder->begin(start_, state.position, h, ContactFinder::ForcesAct::kAtEnd) : nullptr;
  if (contacts != nullptr) project(h, *contacts, state.position);
  clock.lap(Stage::kContact);
  for (const Chain& chain : chains_) rebuild(chain, h, state);
  clock.lap(Stage::kWarp);
  const bool held = contacts == nullptr || holdBack(*finder, *contacts, h, state);
  boundEnergy(forces, state);
  if (contacts != nullptr) stopApproach(*contacts, state.velocity);
  const bool sound = held && this->sound(state, h);
  if (!sound) stop(state);
  clock.lap(Stage::kContact);
  state.velocity_age = 0.0;
  SubstepOutcome outcome;
  outcome.accepted = true;
  outcome.settled = sound;
  outcome.share = sound ? 1.0 : 0.0;
  outcome.pins_wait = !sound;
  outcome.sweeps = 1;
  outcome.scale = h * h;
  outcome.kick = h;
  return outcome;
}

}  // namespace curtain
