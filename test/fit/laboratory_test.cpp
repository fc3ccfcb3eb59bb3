// SPDX-License-Identifier: BSD-3-Clause
//
// From a laboratory's figures to a preset, against values worked out by hand.
#include "fit/laboratory.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace {

using curtain::ClothParams;
using curtain_fit::BiasSample;
using curtain_fit::Laboratory;
using curtain_fit::Preset;
using curtain_fit::Quantity;
using curtain_fit::readQuantity;

Quantity weight(const char* text) { return readQuantity("--weight", text, curtain_fit::kWeights); }
Quantity length(const char* text) { return readQuantity("--warp", text, curtain_fit::kLengths); }
Quantity rigidity(const char* text) { return readQuantity("--warp", text, curtain_fit::kBendings); }

Laboratory fabric(const Quantity& warp, const Quantity& weft) {
  Laboratory laboratory;
  laboratory.weight = weight("200g/m2");
  laboratory.warp = warp;
  laboratory.weft = weft;
  return laboratory;
}

// 0.2 kg/m^2 * 9.81 m/s^2 * (0.02 m)^3 = 1.5696e-5 N m.
TEST(Laboratory, BendingLengthIsPeirces) {
  const Preset preset = curtain_fit::presetOf(ClothParams(), "", fabric(length("2cm"), length("10mm")));
  EXPECT_NEAR(preset.cloth.bending_warp, 1.5696e-5, 1e-12);
  EXPECT_NEAR(preset.cloth.bending_weft, 1.5696e-5 / 8.0, 1e-12);
  EXPECT_EQ(preset.cloth.surface_density, 0.2);
  EXPECT_EQ(preset.keys.size(), 3u);
  EXPECT_TRUE(preset.notes.empty());
}

TEST(Laboratory, OverhangIsTwiceTheBendingLength) {
  Laboratory laboratory = fabric(length("4cm"), rigidity("5uN.m"));
  laboratory.overhangs = true;
  const Preset preset = curtain_fit::presetOf(ClothParams(), "", laboratory);
  EXPECT_NEAR(preset.cloth.bending_warp, 1.5696e-5, 1e-12);
  EXPECT_NEAR(preset.cloth.bending_weft, 5e-6, 1e-15);  // a rigidity is no length
}

// B = 4 and 8 uN m. Wide: D_t = B45 - 3 uN m. Narrow: 1 / D_t = 4 / B45 - 1 / 4 - 1 / 8; of 5 uN m 2.3529 uN m.
TEST(Laboratory, BiasIsThatOfWideCloth) {
  EXPECT_NEAR(curtain_fit::twistOf(4e-6, 8e-6, 5e-6, BiasSample::kWide), 2e-6, 1e-15);
  EXPECT_NEAR(curtain_fit::twistOf(4e-6, 8e-6, 5e-6, BiasSample::kNarrow), 2.352941e-6, 1e-12);
  Laboratory laboratory = fabric(rigidity("4uN.m"), rigidity("8uN.m"));
  laboratory.bias = rigidity("5uN.m");
  EXPECT_NEAR(curtain_fit::presetOf(ClothParams(), "", laboratory).cloth.bending_bias, 5.352941e-6,
              1e-12);  // FAST: a strip
  laboratory.bias_sample = BiasSample::kWide;
  EXPECT_NEAR(curtain_fit::presetOf(ClothParams(), "", laboratory).cloth.bending_bias, 5e-6, 1e-15);
  laboratory.bias_sample.reset();
  laboratory.bias = rigidity("0.05gf.cm2/cm");  // 4.903325 uN m by KES: wide
  EXPECT_NEAR(curtain_fit::presetOf(ClothParams(), "", laboratory).cloth.bending_bias, 4.903325e-6, 1e-12);
}

TEST(Laboratory, BiasThatNoTwistExplainsIsSaid) {
  Laboratory laboratory = fabric(rigidity("4uN.m"), rigidity("8uN.m"));
  laboratory.bias = rigidity("2uN.m");
  laboratory.bias_sample = BiasSample::kWide;
  const Preset limp = curtain_fit::presetOf(ClothParams(), "", laboratory);
  EXPECT_EQ(limp.cloth.bending_bias, 0.0);
  ASSERT_EQ(limp.notes.size(), 1u);
  EXPECT_NE(limp.notes[0].find("D_t = -1e-06 N m"), std::string::npos) << limp.notes[0];
  laboratory.bias = rigidity("12uN.m");  // a strip free to twist has 4 / (1 / 4 + 1 / 8) = 10.7 uN m at most
  laboratory.bias_sample = BiasSample::kNarrow;
  EXPECT_EQ(curtain_fit::presetOf(ClothParams(), "", laboratory).notes.size(), 1u);
}

TEST(Laboratory, SaysThatACantileverHasFrictionInIt) {
  Laboratory laboratory = fabric(length("2cm"), length("2cm"));
  laboratory.hysteresis = readQuantity("--hysteresis", "1e-3N", curtain_fit::kHystereses);
  EXPECT_EQ(curtain_fit::presetOf(ClothParams(), "", laboratory).notes.size(), 1u);
  laboratory.warp = laboratory.weft = rigidity("0.118gf.cm2/cm");
  const Preset preset = curtain_fit::presetOf(ClothParams(), "", laboratory);
  EXPECT_TRUE(preset.notes.empty());
  EXPECT_EQ(preset.cloth.bending_hysteresis, 1e-3);
}

TEST(Laboratory, NeedsAFabric) {
  Laboratory laboratory;
  laboratory.weight = weight("200g/m2");
  EXPECT_THROW(curtain_fit::presetOf(ClothParams(), "", laboratory), std::invalid_argument);
  ClothParams base;
  base.bending_warp = base.bending_weft = 1e-5;
  const Preset preset = curtain_fit::presetOf(base, "material x", laboratory);
  EXPECT_EQ(preset.cloth.bending_warp, 1e-5);
  EXPECT_EQ(preset.cloth.surface_density, 0.2);
}

}  // namespace
