// SPDX-License-Identifier: BSD-3-Clause
//
// Closed cloth starts as a cone around the vertical: row i, at s_i along the warp, is a ring of radius r_0 + s_i
// sin(tilt).
#pragma once

#include <algorithm>
#include <cmath>

#include "curtain_sim/scene.h"
#include "scene/pi.h"
#include "scene/shares.h"

namespace curtain {

/// Radius of the hung ring as it is given [m].
inline double typedRadius(const Scene& scene) { return scene.hang.radius.value_or(scene.cloth.width / (2.0 * kPi)); }

/// The same, as much smaller as it takes for no weft link to start longer than it is [m]: radii that fit the cloth but
/// for their rounding. The whole cone is drawn in, so that the rods keep their lengths.
inline double hungRadius(const Scene& scene) {
  const ClothParams& cloth = scene.cloth;
  const std::vector<double> rods = shareOut(1.0, cloth.row_spacing, cloth.rows - 1);
  const std::vector<double> links = shareOut(1.0, cloth.column_spacing, cloth.columns);
  // A link is the chord of its share of the turn; the shortest one bounds the radius.
  const double share = *std::min_element(links.begin(), links.end());
  const double radius_per_width = share / (2.0 * std::sin(kPi * share));
  double down = 0.0, excess = 0.0;
  for (int i = 0; i < cloth.rows; ++i) {
    if (i > 0) down += rods[static_cast<std::size_t>(i - 1)];
    const double radius = typedRadius(scene) + down * cloth.height * std::sin(scene.hang.tilt);
    excess = std::max(excess, radius - radius_per_width * rowWidth(cloth, down));
  }
  return typedRadius(scene) - excess;
}

}  // namespace curtain
