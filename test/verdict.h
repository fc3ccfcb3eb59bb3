// SPDX-License-Identifier: BSD-3-Clause
//
// What every run of a scene is judged by, frame by frame, whoever made the scene: numbers, lengths of links, energy,
// how much was solved.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "curtain_sim/simulator.h"
#include "energy_books.h"

namespace curtain_test {

struct Verdict {
  std::vector<std::string> faults;  ///< with the frame they were first seen at; empty: it holds
  bool finite = true;               ///< all that a user may ask for
  double stretch = 0.0;             ///< largest of any link, over or under its length, at any frame's end
  double energy_gain = 0.0;         ///< that nobody has put in, as EnergyBooks measures it
  std::int64_t frames = 0, substeps = 0, rejected = 0, sweeps = 0, unsettled = 0;
  std::int64_t last_resort = 0;  ///< substeps that the last resort made
  std::int64_t stops = 0;        ///< of them, those in which the cloth stayed where it was
  std::int64_t max_solves = 0;   ///< substeps solved in one frame, rejected ones included
  double momentum_cut = 0.0;     ///< [N s]
  double seconds = 0.0;          ///< computing time
  double slowest = 0.0;          ///< frame [s]

  bool holds() const { return faults.empty(); }
  void fault(const std::string& what) { faults.push_back(what + " at frame " + std::to_string(frames)); }
  /// Not a number is more than anything.
  void atMost(double bound, const std::string& what, double value) {
    std::ostringstream text;
    text << what << " " << value << " > " << bound;
    if (!(value <= bound)) fault(text.str());
  }
};

inline double worstLink(const curtain::Statistics& s) {
  return std::max({s.warp_stretch, s.warp_compression, s.weft_stretch});
}

/// Looks at a simulator after each of its frames. Energy is looked at where it has a meaning.
class Watch {
 public:
  /// remembered: see EnergyBooks.
  explicit Watch(const curtain::Simulator& simulator, std::size_t remembered = 60)
      : books_(weightScale(simulator), remembered) {
    open(simulator);
  }

  /// The books begin here.
  void open(const curtain::Simulator& simulator) { books_.open(simulator); }

  void look(const curtain::Simulator& simulator, Verdict& verdict) {
    const curtain::Statistics& s = simulator.statistics();
    verdict.frames = s.frames;
    verdict.max_solves = std::max(verdict.max_solves, s.substeps_last + s.rejected - verdict.rejected);
    verdict.substeps = s.substeps;
    verdict.rejected = s.rejected;
    verdict.sweeps = s.sweeps;
    verdict.unsettled = s.unsettled;
    verdict.last_resort = s.last_resort_substeps;
    verdict.stops = s.stops;
    verdict.momentum_cut = s.momentum_cut;
    verdict.seconds = s.step_seconds_sum;
    verdict.slowest = s.step_seconds_max;
    verdict.stretch = std::max(verdict.stretch, worstLink(s));
    lookAtNumbers(simulator, verdict);
  }
  void lookAtEnergy(const curtain::Simulator& simulator, bool gravity_changes, Verdict& verdict) {
    books_.look(simulator, gravity_changes);
    verdict.energy_gain = books_.gain();
  }

 private:
  void lookAtNumbers(const curtain::Simulator& simulator, Verdict& verdict) {
    const auto must = [&](bool finite, const char* what) {
      verdict.finite = verdict.finite && finite;
      if (!finite) verdict.fault(std::string("not finite: ") + what);
    };
    const auto all = [](const std::vector<curtain::Vec3>& values) {
      return std::all_of(values.begin(), values.end(), [](const curtain::Vec3& value) { return value.allFinite(); });
    };
    simulator.copyPositions(values_);
    must(all(values_), "positions");
    simulator.copyVelocities(values_);
    must(all(values_), "velocities");
    simulator.copyForces(values_);
    must(all(values_), "forces");
    simulator.copyFineMesh(mesh_);
    must(all(mesh_.positions), "the fine mesh");
    const curtain::Energy energy = simulator.energy();
    must(std::isfinite(energy.kinetic) && std::isfinite(energy.potential), "energy");
    must(simulator.statistics().finite, "the statistics say so");
  }

  EnergyBooks books_;
  std::vector<curtain::Vec3> values_;
  curtain::FineMesh mesh_;
};

}  // namespace curtain_test
