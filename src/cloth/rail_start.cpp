// SPDX-License-Identifier: BSD-3-Clause
//
// Start of cloth on a rail. Each column hangs plumb from its place on the top edge. Between carriers the edge hangs
// through, in a V that stands out from the rail by a quarter of the carriers' distance, to one side and the other by
// turns, as pleats do:
//
//     o--------o        from the front        o   \ /   o     from above
//      \      /                                    v
//        \  /
#include <algorithm>
#include <cmath>

#include "cloth/cloth.h"

namespace curtain {
namespace {

constexpr double kOut = 0.25;             // of the carriers' distance
constexpr double kLengthRounding = 1e-6;  // relative, for rounding of lengths
const Vec3 kDown = -Vec3::UnitZ();        // where cloth starts to hang towards, whatever gravity is

}  // namespace

void placeOnRail(const ClothPattern& pattern, const std::vector<double>& places, bool hangs_through, Field3& position) {
  const Grid& grid = pattern.grid;
  const RailPattern& rail = pattern.rails.front();
  // All rows are as wide as the top edge, and the hem may be narrower by its rounding.
  const double hem = pattern.weft_rest[grid.index(grid.rows - 1, 1)] / pattern.weft_rest[grid.index(0, 1)];
  const double narrowest = std::min(1.0, hem);
  for (std::size_t k = 0; k + 1 < places.size(); ++k) {
    const int first = rail.columns[k], last = rail.columns[k + 1];
    const Vec3 a = rail.path.at(places[k]).point, b = rail.path.at(places[k + 1]).point;
    const double from = pattern.weft_coordinate[static_cast<std::size_t>(first)];
    const double cloth = pattern.weft_coordinate[static_cast<std::size_t>(last)] - from;
    const double apart = (b - a).norm(), reach = (1.0 - kLengthRounding) * narrowest * cloth;
    // Half of the V: (apart / 2, out, through) is as long as half of the cloth.
    const double free_square = hangs_through ? std::max(0.0, 0.25 * (reach * reach - apart * apart)) : 0.0;
    const double out = std::min(kOut * apart, std::sqrt(free_square));
    const double through = std::sqrt(std::max(0.0, free_square - out * out));
    const Vec3 normal = (k % 2 == 0 ? 1.0 : -1.0) * (b - a).cross(Vec3::UnitZ()).normalized();
    for (int j = first; j <= last; ++j) {
      const double share = (pattern.weft_coordinate[static_cast<std::size_t>(j)] - from) / cloth;
      const double leg = 1.0 - std::abs(2.0 * share - 1.0);
      position.set(grid.index(0, j), a + share * (b - a) + leg * (out * normal + through * kDown));
    }
    position.set(grid.index(0, first), a);
    position.set(grid.index(0, last), b);
  }
  for (int i = 1; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      position.set(n, position.at(grid.index(i - 1, j)) + pattern.warp_rest[n] * kDown);
    }
  }
}

}  // namespace curtain
