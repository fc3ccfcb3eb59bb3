// SPDX-License-Identifier: BSD-3-Clause
//
// A trial carried out frame by frame, and what is wrong with it, if anything.
#pragma once

#include "judge/draw.h"
#include "verdict.h"

namespace curtain_test {

struct TrialVerdict : Verdict {
  double energy_finer = 0.0;  ///< gained in finer steps, where it was looked at
  // What was judged, of the frames.
  std::int64_t brute_forced = 0;  ///< looked at by brute force
  std::int64_t crossings = 0,
               crossings_excused = 0;  ///< of them, with self-contact; not judged: Court::crossings_judged_
  std::int64_t links_excused = 0;      ///< hands that do not give may have pulled links apart
  std::int64_t energy_judged = 0;
  std::int64_t obstacles = 0, obstacles_excused = 0;  ///< over all obstacles: of them not judged, as Court::judged_
  std::uint64_t hash = 0;                             ///< of where it ends
};

struct Rigour {
  bool brute_force = true;  ///< crossings and piercings at every frame, by brute force
  bool energy = true;       ///< rises by no more than is put in
  bool repeats = false;  ///< a second run, interrupted by a snapshot in the middle and with caches cleared at random,
                         ///< ends with the same bits
  double max_seconds = 0.0;  ///< of computing time, then it is given up as too slow; 0: as long as it takes
};

TrialVerdict judge(const Drawn& drawn, const Rigour& rigour);

/// Makes a trial that does not hold smaller as long as it does not: fewer nodes, forces, obstacles, less time.
Drawn shrink(Drawn drawn, const Rigour& rigour);

}  // namespace curtain_test
