// SPDX-License-Identifier: BSD-3-Clause
//
// A torture carried out, and what came of it.
#pragma once

#include <limits>

#include "stress/torture.h"
#include "verdict.h"

namespace curtain_test {

constexpr double kNotJudged = std::numeric_limits<double>::infinity();

struct Trial : Verdict {                                             // its stretch is that during the torture
  double stretch_after = 0.0;                                        ///< at the end
  double kinetic = 0.0;                                              ///< most of it during the torture, over m g H
  double stretch_allowed = kNotJudged, energy_allowed = kNotJudged;  ///< by the torture
  double recovery = 0.0;          ///< time until it was at rest again [s]; NaN: it never was
  double recovery_allowed = 0.0;  ///< that the air allows [s]; NaN: not asked for
  bool repeated = false;
  bool same_bits = true;  ///< of what was repeated
};

/// twice: carried out a second time, for the same bits.
Trial carryOut(const Torture& torture, curtain::Method method, bool twice);

}  // namespace curtain_test
