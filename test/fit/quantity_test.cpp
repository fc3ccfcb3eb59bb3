// SPDX-License-Identifier: BSD-3-Clause
//
// Units against conversions by hand, from the definitions: 1 gf = 9.80665e-3 N, 1 cm = 1e-2 m, 180 deg = pi.
#include "fit/quantity.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace {

using curtain_fit::readQuantity;
using curtain_fit::Unit;

struct Conversion {
  const char* text;
  const std::vector<Unit>& units;
  double si;
};

TEST(Quantity, IsInSi) {
  const Conversion conversions[] = {
      {"183g/m2", curtain_fit::kWeights, 0.183},
      {"0.183 kg/m^2", curtain_fit::kWeights, 0.183},
      {"23.5mm", curtain_fit::kLengths, 0.0235},
      {"2.35cm", curtain_fit::kLengths, 0.0235},
      {"0.0235m", curtain_fit::kLengths, 0.0235},
      {"0.118 gf.cm2/cm", curtain_fit::kBendings, 1.1571847e-5},  // 0.118 * 9.80665e-3 N * 1e-2 m
      {"11.57uN.m", curtain_fit::kBendings, 1.157e-5},
      {"1.157e-5N.m", curtain_fit::kBendings, 1.157e-5},
      {"0.124gf.cm/cm", curtain_fit::kHystereses, 1.2160246e-3},  // 0.124 * 9.80665e-3 N
      {"1.2e-3N", curtain_fit::kHystereses, 1.2e-3},
      {"1gf/cm.deg", curtain_fit::kShears, 56.1879656},  // 0.980665 N/m a degree, times 57.2957795
      {"40N/m", curtain_fit::kShears, 40.0},
      {"82.9%", curtain_fit::kShares, 0.829},
  };
  for (const Conversion& conversion : conversions) {
    const curtain_fit::Quantity quantity = readQuantity("--x", conversion.text, conversion.units);
    EXPECT_NEAR(quantity.value, conversion.si, 1e-8 * conversion.si) << conversion.text;
    EXPECT_EQ(quantity.text, conversion.text);
  }
}

TEST(Quantity, NamesWhatIsWrong) {
  for (const char* text : {"", "183", "g/m2", "183mm", "-183g/m2", "0g/m2", "nang/m2", "infg/m2", "1,83g/m2"}) {
    try {
      readQuantity("--weight", text, curtain_fit::kWeights);
      ADD_FAILURE() << text;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(error.what(), std::string("--weight: must be a number > 0 and a unit: g/m2, kg/m2; is '") + text + "'");
    }
  }
  EXPECT_EQ(readQuantity("--hysteresis", "0N", curtain_fit::kHystereses, true).value, 0.0);
}

}  // namespace
