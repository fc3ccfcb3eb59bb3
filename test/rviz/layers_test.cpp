// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/surface/layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "rviz/state_of.h"

namespace curtain_rviz {
namespace {

using curtain_test::blownCloth;
using curtain_test::loadsOf;
using curtain_test::stateOf;

TEST(Layers, SpeedIsThatOfTheNodes) {
  const curtain::Simulator simulator = blownCloth(false);
  std::vector<float> values;
  valuesOf(Layer::kSpeed, stateOf(simulator), nullptr, values);
  std::vector<curtain::Vec3> velocities;
  simulator.copyVelocities(velocities);
  ASSERT_EQ(values.size(), velocities.size());
  for (std::size_t n = 0; n < values.size(); ++n) EXPECT_NEAR(values[n], velocities[n].norm(), 1e-5);
  EXPECT_GT(*std::max_element(values.begin(), values.end()), 0.1F) << "it is blown about";
}

// Two nodes of a cloth whose links are as long as at rest are pulled apart by a tenth of the link between them.
TEST(Layers, StrainIsThatOfTheMostStretchedLink) {
  curtain::Scene scene;
  scene.cloth.rows = 4;
  scene.cloth.columns = 5;
  scene.cloth.height = 0.3;
  scene.cloth.width = 0.4;
  scene.hang.to.x() = 0.4;
  curtain_sim::CurtainState state = stateOf(curtain::Simulator(scene));
  std::vector<float> values;
  valuesOf(Layer::kStrain, state, nullptr, values);
  for (const float value : values) EXPECT_NEAR(value, 0.0F, 1e-3F) << "[%], of floats at 2 m in links of 0.1 m";
  state.positions[3 * 4] += 0.01F;  // the last node of the top row, along the weft
  valuesOf(Layer::kStrain, state, nullptr, values);
  EXPECT_NEAR(values[4], 10.0F, 1e-3F);
  EXPECT_NEAR(values[3], 10.0F, 1e-3F);
  EXPECT_NEAR(values[9], 0.4988F, 1e-3F) << "the rod below leans: sqrt(1 + 0.1^2) - 1";
  EXPECT_NEAR(values[2], 0.0F, 1e-3F);
}

TEST(Layers, TensionIsThatOfTheLinkThatBearsMost) {
  const curtain_sim::CurtainState state = stateOf(blownCloth(true));
  curtain_sim::Loads loads = loadsOf(blownCloth(true));
  std::fill(loads.warp_tension.begin(), loads.warp_tension.end(), 0.0F);
  std::fill(loads.weft_tension.begin(), loads.weft_tension.end(), 0.0F);
  loads.warp_tension[7 + 2] = -3.0F;  // a rod that pushes, between (0, 2) and (1, 2)
  loads.weft_tension[14] = 2.0F;      // the link that closes the third row
  std::vector<float> values, expected(56, 0.0F);
  expected[2] = expected[9] = 3.0F;
  expected[14] = expected[20] = 2.0F;
  valuesOf(Layer::kTension, state, &loads, values);
  EXPECT_EQ(values, expected);
}

TEST(Layers, ContactIsTheForcesSize) {
  const curtain_sim::CurtainState state = stateOf(blownCloth(false));
  curtain_sim::Loads loads = loadsOf(blownCloth(false));
  loads.contact_forces[3] = 3.0F;
  loads.contact_forces[5] = -4.0F;
  std::vector<float> values;
  valuesOf(Layer::kContact, state, &loads, values);
  EXPECT_EQ(values[1], 5.0F);
  EXPECT_EQ(values[0], 0.0F);
}

TEST(LayerRange, GrowsAtOnceAndShrinksSlowly) {
  LayerRange range;
  EXPECT_DOUBLE_EQ(range.follow({0.0F, 0.3F}, 0.03), 0.5);
  EXPECT_DOUBLE_EQ(range.follow({0.0F, 3.0F}, 0.03), 5.0);
  EXPECT_DOUBLE_EQ(range.follow({0.0F, 0.3F}, 0.03), 5.0);
  double shown = 0.0, end = 5.0;  // [s] that the smaller values are shown
  while (end > 0.5 && shown < 60.0) {
    end = range.follow({0.3F}, 0.1);
    shown += 0.1;
  }
  // Its peak falls to 1/e in 4 s, from 3 to the 0.5 where the range is read; 0.03 s of it are over, and it is looked at
  // every 0.1 s.
  EXPECT_NEAR(shown, 4.0 * std::log(6.0) - 0.03, 0.1);
  EXPECT_GT(LayerRange().follow({}, 1.0), 0.0) << "also of nothing";
}

TEST(LayerRange, EndsAreNumbersThatReadWell) {
  for (const auto& [x, end] : std::vector<std::pair<double, double>>{
           {1.0, 1.0}, {1.01, 2.0}, {2.1, 5.0}, {5.1, 10.0}, {0.04, 0.05}, {1e-6, 1e-6}, {730.0, 1000.0}}) {
    EXPECT_NEAR(roundUp(x), end, 1e-9 * end) << x;
  }
  EXPECT_EQ(legendNumber(0.05), "0.05");
  EXPECT_EQ(legendNumber(20.0), "20");
}

}  // namespace
}  // namespace curtain_rviz
