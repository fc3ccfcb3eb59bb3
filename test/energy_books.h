// SPDX-License-Identifier: BSD-3-Clause
//
// What a simulator's energy has risen by that nobody has put in.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "curtain_sim/simulator.h"

namespace curtain_test {

/// Of the nodes that can move [kg].
inline double freeMass(const curtain::Simulator& simulator) {
  double sum = 0.0;
  for (int i = 0; i < simulator.rows(); ++i) {
    for (int j = 0; j < simulator.columns(); ++j) sum += simulator.pinned({i, j}) ? 0.0 : simulator.mass({i, j});
  }
  return sum;
}

/// m g H [J].
inline double weightScale(const curtain::Simulator& simulator) {
  const curtain::Scene& scene = simulator.scene();
  return std::max(1e-12, freeMass(simulator) * std::max(1e-3, scene.gravity.norm()) * scene.cloth.height);
}

/// What the scheme itself may add, in the measure of EnergyBooks: leapfrog's energy wavers, and
/// src/simulator/closed_frames.cpp steps in beyond that.
constexpr double kSchemeGain = 1e-2;

/// What links may hide that lack a share e of their lengths: a straight row between pins sags by sqrt(3 e / 8) of its
/// width, the cloth by two thirds of that on the mean; it may lie anywhere between, and get there by a swing of the
/// same energy.
inline double slackGain(double lacking) { return 2.0 * 2.0 / 3.0 * std::sqrt(3.0 / 8.0 * lacking); }

/// Energy of the state's nodes that can move: pins lift nothing but themselves.
inline double freeEnergy(const curtain::Simulator& simulator) {
  const curtain::Energy energy = simulator.energy();
  double of_pins = 0.0;
  for (int i = 0; i < simulator.rows(); ++i) {
    for (int j = 0; j < simulator.columns(); ++j) {
      if (simulator.pinned({i, j}))
        of_pins -= simulator.mass({i, j}) * simulator.scene().gravity.dot(simulator.position({i, j}));
    }
  }
  return energy.kinetic + energy.potential - of_pins;
}

/// Follows the ledger: how far the energy has risen above what was put in, over what moves: m g H, the kinetic energy
/// meanwhile and the works of the last frames. Two accounts, and what counts is what both see: the ledger's own kinetic
/// energy (leapfrog's, half a substep late, exact for any force), and the energy of the synchronised state (free of
/// what that wavers by on smooth motion, but half a kick ahead of a sudden force).
class EnergyBooks {
 public:
  /// remembered: work that was put in so many frames ago is no excuse any more.
  explicit EnergyBooks(double weight_scale, std::size_t remembered = 60)
      : scale_(weight_scale), works_(remembered, 0.0) {}

  void open(const curtain::Simulator& simulator) {
    last_energy_ = freeEnergy(simulator);
    own_.max_kinetic = synchronised_.max_kinetic = simulator.energy().kinetic;
  }
  void look(const curtain::Simulator& simulator, bool gravity_changes) {
    const curtain::Work work = simulator.work();
    const double forces = work.forces + work.drive - last_.forces - last_.drive, pins = work.pins - last_.pins,
                 obstacles = work.obstacles - last_.obstacles;
    works_[frame_++ % works_.size()] = std::abs(forces) + std::abs(pins) + std::abs(obstacles);
    const double moves = std::accumulate(works_.begin(), works_.end(), scale_);
    const double put_in = forces + pins + obstacles, kinetic = simulator.energy().kinetic,
                 energy = freeEnergy(simulator);
    const double own = own_.add(
        work.kinetic - last_.kinetic - (work.gravity - last_.gravity) - (work.elastic - last_.elastic) - put_in,
        kinetic, moves);
    const double synchronised = synchronised_.add(energy - last_energy_ - put_in, kinetic, moves);
    worst_ = std::max(worst_, gravity_changes ? own : std::min(own, synchronised));
    last_ = work;
    last_energy_ = energy;
  }
  double gain() const { return worst_; }

 private:
  struct Account {
    double level = 0.0, lowest = 0.0, max_kinetic = 0.0;
    double add(double change, double kinetic, double moves) {
      level += change;
      if (level <= lowest) {
        lowest = level;
        max_kinetic = 0.0;
      }
      max_kinetic = std::max(max_kinetic, kinetic);
      return (level - lowest) / (moves + max_kinetic);
    }
  };
  curtain::Work last_;
  Account own_, synchronised_;
  double scale_, last_energy_ = 0.0, worst_ = 0.0;
  std::vector<double> works_;
  std::size_t frame_ = 0;
};

}  // namespace curtain_test
