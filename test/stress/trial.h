// SPDX-License-Identifier: BSD-3-Clause
//
// A torture carried out, and what came of it.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "stress/torture.h"

namespace curtain_test {

constexpr double kNotJudged = std::numeric_limits<double>::infinity();

struct Trial {
  bool finite = true;
  double stretch = 0.0;                                              ///< largest at a frame's end during the torture
  double stretch_after = 0.0;                                        ///< at the end
  double energy_gain = 0.0;                                          ///< see Torture
  double kinetic = 0.0;                                              ///< most of it during the torture, over m g H
  double stretch_allowed = kNotJudged, energy_allowed = kNotJudged;  ///< by the torture
  double recovery = 0.0;          ///< time until it was at rest again [s]; NaN: it never was
  double recovery_allowed = 0.0;  ///< that the air allows [s]; NaN: not asked for
  bool repeated = false;
  bool same_bits = true;  ///< of what was repeated
  std::int64_t frames = 0, unsettled = 0, last_resort = 0, stops = 0;
  double milliseconds = 0.0;          ///< the slowest frame
  double seconds = 0.0;               ///< computing time of it all
  std::vector<std::string> failures;  ///< what it did not hold
  bool holds() const { return failures.empty(); }
};

/// twice: carried out a second time, for the same bits.
Trial carryOut(const Torture& torture, curtain::Method method, bool twice);

}  // namespace curtain_test
