// SPDX-License-Identifier: BSD-3-Clause
#include "scene/fan.h"

#include <algorithm>
#include <cmath>

#include "scene/infinity.h"
#include "scene/shares.h"
#include "scene/strips.h"

namespace curtain {
namespace {

// A hem that takes more rounds to find is next to none that is too steep.
constexpr int kRounds = 200;
constexpr double kHemRounding = 1e-15;  // relative

// The largest rise of the hem from column to column, over the columns' share of the width [m]. Infinite: the outermost
// would have to lean by more than a right angle.
double steepestRise(const Scene& scene, double narrower) {
  const double longest = longestEdge(scene), lean = narrower / scene.cloth.height;
  if (lean > 2.0) return kInfinity;
  const auto fall = [&](double share) { return scene.cloth.height * std::sqrt(1.0 - lean * lean * share * share); };
  double along = 0.0, steepest = 0.0;
  for (const double width : edgeWidths(scene)) {
    const double left = along / longest - 0.5, right = (along + width) / longest - 0.5;
    along += width;
    if (!(width > 0.0)) continue;
    const double rise = std::abs(fall(right) - fall(left)) / (right - left);
    steepest = std::max(steepest, rise);
  }
  return steepest;
}

}  // namespace

// Over its share of the width, a link at a share s of the height is as long as the root of the row's width squared and
// of (s times the hem's rise) squared. That is convex in s, the link's own length is linear, and the top row fits: so
// where the hem fits, all rows do. Each round takes the width that the last one's rise leaves of the hem. This leads
// down to the widest that fits, since a narrower hem rises more.
std::optional<double> startingHem(const Scene& scene, double span) {
  const double own = hemWidth(scene.cloth) / scene.cloth.width * longestEdge(scene);
  double hem = std::min(span, own);
  for (int round = 0; round < kRounds && hem > 0.0; ++round) {
    const double rise = steepestRise(scene, span - hem);
    if (!(rise < own)) return std::nullopt;
    const double next = std::min(span, std::sqrt(own * own - rise * rise));
    if (next >= (1.0 - kHemRounding) * hem) return next;
    hem = next;
  }
  return std::nullopt;
}

}  // namespace curtain
