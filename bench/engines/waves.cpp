// SPDX-License-Identifier: BSD-3-Clause
#include "bench/engines/waves.h"

#include <utility>

namespace curtain_bench {
namespace {

constexpr double kWaves = 5.0;

// y of the wave at x, both over the width.
double waveAt(double x, double height) { return height * std::sin(2.0 * std::acos(-1.0) * kWaves * x); }

// The next point of the wave that is `link` away along a chord, all over the width.
double nextAlong(double x, double height, double link) {
  double least = x, most = x + link;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (least + most);
    const double rise = waveAt(middle, height) - waveAt(x, height);
    const bool beyond = std::hypot(middle - x, rise) > link;
    (beyond ? most : least) = middle;
  }
  return 0.5 * (least + most);
}

std::vector<double> row(double height, double link, int columns) {
  std::vector<double> places = {0.0};
  while (static_cast<int>(places.size()) < columns) places.push_back(nextAlong(places.back(), height, link));
  return places;
}

}  // namespace

ClothStart inWaves(ClothStart start) {
  const auto columns = static_cast<std::size_t>(start.columns);
  const double from = start.positions.x.front(), width = start.positions.x[columns - 1] - from;
  const double link = start.weft_rest / width;
  double least = 0.0, most = 1.0;  // height of the waves with which a row ends at the width
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (least + most);
    const bool too_low = row(middle, link, start.columns).back() > 1.0;
    (too_low ? least : most) = middle;
  }
  const double height = 0.5 * (least + most);
  const std::vector<double> places = row(height, link, start.columns);
  for (std::size_t n = 0; n < start.count(); ++n) {
    start.positions.x[n] = from + width * places[n % columns];
    start.positions.y[n] += width * waveAt(places[n % columns], height);
  }
  return start;
}

}  // namespace curtain_bench
