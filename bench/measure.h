// SPDX-License-Identifier: BSD-3-Clause
//
// The one stop watch and the measures that every contestant is put to.
#pragma once

#include <functional>
#include <vector>

#include "bench/contestant.h"

namespace curtain_bench {

/// No node is beyond numbers, or a kilometre off.
bool isSound(const Points& positions);

/// What of the cloth is in the scene's ball; without one, nothing.
struct Inside {
  int nodes = 0;
  double deepest = 0.0;  ///< [m]
};
Inside insideOf(const ClothStart& start, double time, const Points& positions);

/// Largest relative misfit of any link: of rods both ways, of weft links what they are too long.
double largestStretch(const ClothStart& start, const Points& positions);

/// Root mean square over the free nodes of the distance between two states [m].
double rmsDistance(const ClothStart& start, const Points& a, const Points& b);

/// Kinetic energy, that of gravity (zero at the origin) and that of springs [J].
double totalEnergy(const ClothStart& start, const Contestant& contestant);
double gravityEnergy(const ClothStart& start, const Points& positions);
double kineticEnergy(const ClothStart& start, const Points& velocities);

double median(std::vector<double> values);

/// What a run gave.
struct Run {
  double ms = 0.0;            ///< computing time of all frames
  double frame_median = 0.0;  ///< [ms]
  double frame_max = 0.0;     ///< [ms]
  double stretch = 0.0;       ///< largest at any frame's end
  int substeps = 0;           ///< of all frames
  int frames = 0;             ///< made; fewer than asked for when cut short
  bool sound = true;          ///< isSound() after every frame
  bool cut = false;           ///< it took longer than its budget
  Points end;
};

/// Called after every frame (from 1), outside of what is timed.
using FrameCall = std::function<void(int frame, const Contestant& contestant, const Points& positions)>;

/// Makes frames, each timed by itself with the steady clock. Ends early at a state that is not sound or past the budget
/// of computing time [s].
Run run(const ClothStart& start, Contestant& contestant, int frames, double budget_seconds,
        const FrameCall& call = nullptr);

}  // namespace curtain_bench
