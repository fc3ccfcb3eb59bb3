// SPDX-License-Identifier: BSD-3-Clause
//
// A trial carried out frame by frame, and what is wrong with it, if anything.
#pragma once

#include <string>
#include <vector>

#include "judge/draw.h"

namespace curtain_test {

struct Verdict {
  std::vector<std::string> faults;  ///< with the frame they were first seen at; empty: it holds
  double stretch = 0.0;             ///< largest of any link, over or under its length, at any frame's end
  std::int64_t frames = 0, substeps = 0, rejected = 0, sweeps = 0;
  std::int64_t last_resort = 0;  ///< substeps that the last resort made
  std::int64_t stops = 0;        ///< of them, those in which the cloth stayed where it was
  double energy_gain = 0.0;      ///< that nobody has put in, as EnergyBooks measures it
  double energy_finer = 0.0;     ///< the same in finer steps, where it was looked at
  double momentum_cut = 0.0;     ///< [N s]
  std::int64_t max_solves = 0;   ///< substeps solved in one frame, rejected ones included
  // What was judged, of the frames.
  std::int64_t brute_forced = 0;   ///< looked at by brute force
  std::int64_t links_excused = 0;  ///< hands that do not give may have pulled links apart
  std::int64_t energy_judged = 0;
  std::int64_t obstacles = 0, obstacles_excused = 0;  ///< over all obstacles: of them not judged, as Court::judged_
  double seconds = 0.0;                               ///< computing time
  double slowest = 0.0;                               ///< frame [s]
  std::uint64_t hash = 0;                             ///< of where it ends
  bool holds() const { return faults.empty(); }
};

struct Rigour {
  bool brute_force = true;  ///< crossings and piercings at every frame, by brute force
  bool energy = true;       ///< rises by no more than is put in
  bool repeats = false;  ///< a second run, interrupted by a snapshot in the middle and with caches cleared at random,
                         ///< ends with the same bits
  double max_seconds = 0.0;  ///< of computing time, then it is given up as too slow; 0: as long as it takes
};

Verdict judge(const Drawn& drawn, const Rigour& rigour);

/// Makes a trial that does not hold smaller as long as it does not: fewer nodes, forces, obstacles, less time.
Drawn shrink(Drawn drawn, const Rigour& rigour);

}  // namespace curtain_test
