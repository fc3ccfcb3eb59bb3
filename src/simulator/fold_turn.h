// SPDX-License-Identifier: BSD-3-Clause
//
// The least turn of a fold about its chord that pleases. Angles are counted towards the next row of the cloth, "down".
//
//       bow of a fold that must not        Of two turns down is preferred until it is kPreference times as far as up.
//       point into the obstacle            Cloth lies on an obstacle with its normal along the obstacle's, so a fold
//                                          that bows into it mostly needs as far a turn either way: with the shorter
//                                          one
//      up <--- o ---> down                 it would flip at every tremble. So the flip is where cloth rarely is.
//              | bow
//      ========v========= obstacle
#pragma once

#include <optional>

#include "scene/pi.h"

namespace curtain {

constexpr double kPreference = 3.0;

namespace fold_turn {

constexpr int kSteps = 12;      // of a half turn
constexpr int kBisections = 8;  // of one step: the rest is a fifteenth of a degree

/// The least turn in [0, limit] [rad] one way (sign +1 or -1) that pleases.
template <typename Pleases>
std::optional<double> oneWay(double sign, double limit, const Pleases& pleases) {
  constexpr double kStep = kPi / kSteps;
  for (int step = 1; step <= kSteps && (step - 1) * kStep < limit; ++step) {
    if (!pleases(sign * step * kStep)) continue;
    double bad = (step - 1) * kStep;
    double good = step * kStep;
    for (int n = 0; n < kBisections; ++n) {
      const double middle = 0.5 * (bad + good);
      (pleases(sign * middle) ? good : bad) = middle;
    }
    return good;
  }
  return std::nullopt;
}

}  // namespace fold_turn

/// The turn [rad] to make; none: there is no such turn. pleases(turn) is not asked for 0 and may have side effects; the
/// last turn it was asked for need not be the one returned.
template <typename Pleases>
std::optional<double> leastTurn(const Pleases& pleases) {
  const std::optional<double> down = fold_turn::oneWay(1.0, kPi, pleases);
  const double limit = down ? *down / kPreference : kPi;
  const std::optional<double> up = fold_turn::oneWay(-1.0, limit, pleases);
  if (up && *up < limit) return -*up;
  return down ? down : (up ? std::optional<double>(-*up) : std::nullopt);
}

}  // namespace curtain
