// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 8: the shear rigidity with which cloth drapes as it was measured.
#pragma once

#include "fit/drape.h"

namespace curtain_fit {

/// Range of measured fabrics [N/m] (Kawabata 1980: 0.3 to 2 gf/(cm deg)).
constexpr double kMinShear = 17.0, kMaxShear = 110.0;

struct ShearFound {
  double shear = 0.0;                  ///< [N/m]
  std::vector<DrapeReading> readings;  ///< with it
};

/// Of seven rigidities from kMinShear to kMaxShear, each 1.37 times the one before, the one whose mean drape is
/// nearest to a coefficient. Between two of them drape differs by less than from start to start.
ShearFound findShear(curtain::ClothParams cloth, double coefficient, const DrapeTest& test);

}  // namespace curtain_fit
