// SPDX-License-Identifier: BSD-3-Clause
//
// The least turn of a fold about its chord that is accepted. Angles count towards the next row of the cloth, "down".
//
//   bow of a fold that must not        Down is preferred until it is kPreference times as far as up. Cloth lies on an
//   point into the obstacle            obstacle with its normal along the obstacle's, so a fold that bows into it
//                                      mostly needs the same turn either way, and the shorter one would change with
//      up <--- o ---> down             every tremble. With the preference the change is where cloth rarely is.
//              | bow
//      ========v========= obstacle
#pragma once

#include <optional>

#include "scene/pi.h"

namespace curtain {

constexpr double kPreference = 3.0;

namespace fold_turn {

constexpr int kSteps = 12;      // of a half turn
constexpr int kBisections = 8;  // of one step: to within a fifteenth of a degree

/// The least turn in [0, limit] [rad] one way (sign +1 or -1) that is accepted.
template <typename Accepts>
std::optional<double> oneWay(double sign, double limit, const Accepts& accepts) {
  constexpr double kStep = kPi / kSteps;
  for (int step = 1; step <= kSteps && (step - 1) * kStep < limit; ++step) {
    if (!accepts(sign * step * kStep)) continue;
    double bad = (step - 1) * kStep;
    double good = step * kStep;
    for (int n = 0; n < kBisections; ++n) {
      const double middle = 0.5 * (bad + good);
      (accepts(sign * middle) ? good : bad) = middle;
    }
    return good;
  }
  return std::nullopt;
}

}  // namespace fold_turn

/// The turn to make [rad]; none: there is no such turn. accepts(turn) is not called for 0 and may have side effects;
/// its last argument need not be the turn returned.
template <typename Accepts>
std::optional<double> minTurn(const Accepts& accepts) {
  const std::optional<double> down = fold_turn::oneWay(1.0, kPi, accepts);
  const double limit = down ? *down / kPreference : kPi;
  const std::optional<double> up = fold_turn::oneWay(-1.0, limit, accepts);
  if (up && *up < limit) return -*up;
  return down ? down : (up ? std::optional<double>(-*up) : std::nullopt);
}

}  // namespace curtain
