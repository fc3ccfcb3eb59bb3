// SPDX-License-Identifier: BSD-3-Clause
//
// The simulator holds its links however the cloth is pinned.
#include <gtest/gtest.h>

#include "simulator/scenes.h"

namespace curtain {
namespace {

using curtain_test::run;
using curtain_test::sceneOf;

struct PinCase {
  const char* name;
  PinKind kind;
  bool closed;
  std::vector<NodeIndex> nodes;
};

class Pinning : public ::testing::TestWithParam<PinCase> {};

// However it is pinned: links within the tolerance at every frame's end, pins where they were, nothing blows up.
TEST_P(Pinning, HoldsItsLinksInWind) {
  const PinCase& pins = GetParam();
  Scene scene = sceneOf(16, 16);
  scene.cloth.height = 1.0;
  scene.cloth.closed = pins.closed;
  scene.pins.kind = pins.kind;
  scene.pins.nodes = pins.nodes;
  scene.hang.to = Vec3(0.9, 0.0, 2.2);
  scene.air.inside = scene.air.border = scene.air.corner = 0.3;
  WindParams wind;
  wind.id = "gusty";
  wind.position = Vec3(0.3, -2.0, 1.7);
  wind.direction = Vec3(0.2, 1.0, 0.1);
  wind.radius = 3.0;
  wind.pressure = 30.0;
  wind.unsteadiness = 10.0;
  scene.wind.push_back(wind);
  Simulator simulator(scene);
  std::vector<Vec3> start, end;
  simulator.copyPositions(start);
  run(simulator, 300);
  simulator.copyPositions(end);
  const Statistics& s = simulator.statistics();
  EXPECT_TRUE(s.finite);
  EXPECT_LE(s.warp_stretch_max, 1e-3);
  EXPECT_LE(s.warp_compression_max, 1e-3);
  EXPECT_LE(s.weft_stretch_max, 1e-3);
  EXPECT_EQ(s.unsettled, 0);
  int pinned = 0;
  for (int i = 0; i < 16; ++i) {
    for (int j = 0; j < 16; ++j) {
      const auto n = static_cast<std::size_t>(i * 16 + j);
      if (!simulator.pinned({i, j})) continue;
      ++pinned;
      EXPECT_EQ(start[n], end[n]);
    }
  }
  EXPECT_EQ(pinned == 0, pins.kind == PinKind::kNone);
}

INSTANTIATE_TEST_SUITE_P(Everyway, Pinning,
                         ::testing::Values(PinCase{"Top", PinKind::kTop, false, {}},
                                           PinCase{"Left", PinKind::kLeft, false, {}},
                                           PinCase{"TwoCorners", PinKind::kTopCorners, false, {}},
                                           PinCase{"None", PinKind::kNone, false, {}},
                                           PinCase{"Listed", PinKind::kList, false, {{0, 0}, {0, 7}, {8, 15}}},
                                           PinCase{"OneNode", PinKind::kList, false, {{5, 5}}},
                                           PinCase{"ClosedTop", PinKind::kTop, true, {}},
                                           PinCase{"ClosedNone", PinKind::kNone, true, {}},
                                           PinCase{"ClosedListed", PinKind::kList, true, {{0, 0}, {0, 8}}}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace curtain
