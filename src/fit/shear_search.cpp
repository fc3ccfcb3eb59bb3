// SPDX-License-Identifier: BSD-3-Clause
#include "fit/shear_search.h"

#include <cmath>
#include <limits>

namespace curtain_fit {

ShearFound findShear(curtain::ClothParams cloth, double coefficient, const DrapeTest& test) {
  constexpr int kSteps = 6;
  ShearFound best;
  double nearest = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= kSteps; ++k) {
    cloth.shear = kMinShear * std::pow(kMaxShear / kMinShear, static_cast<double>(k) / kSteps);
    std::vector<DrapeReading> readings = drape(cloth, test);
    const double off = std::abs(summaryOf(readings).mean - coefficient);
    if (off >= nearest) continue;
    nearest = off;
    best = {cloth.shear, std::move(readings)};
  }
  return best;
}

}  // namespace curtain_fit
