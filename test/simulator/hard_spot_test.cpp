// SPDX-License-Identifier: BSD-3-Clause
//
// The hard spot: a sheet hung by two corners at 0.9 of its width and dropped flat. All its tension gathers at the pins,
// and the falling sheet is caught by them with a snap.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "curtain_sim/simulator.h"
#include "testing.h"

namespace curtain {
namespace {

class DroppedSheet : public ::testing::TestWithParam<std::pair<int, int>> {};

// With the default settings every link is within the tolerance asked for at every frame's end, by the solver's own word
// (unsettled) as by what is measured.
TEST_P(DroppedSheet, HoldsItsLinks) {
  Scene scene = curtain_test::flatScene(GetParam().first, GetParam().second);
  scene.hang.from = Vec3::Zero();
  scene.hang.to = Vec3(0.9, 0.0, 0.0);
  scene.hang.tilt = 0.5 * curtain_test::kPi;
  scene.pins.kind = PinKind::kTopCorners;
  Simulator simulator(scene);
  for (int frame = 1; frame <= 60; ++frame) {
    simulator.step();
    const Statistics& s = simulator.statistics();
    ASSERT_LE(std::max({s.warp_stretch, s.warp_compression, s.weft_stretch}), scene.solver.stretch_tolerance)
        << "frame " << frame;
  }
  const Statistics& s = simulator.statistics();
  std::printf("%d x %d: stretch %.1e, %lld substeps, %lld rejected\n", simulator.rows(), simulator.columns(),
              std::max(s.weft_stretch_max, s.warp_stretch_max), static_cast<long long>(s.substeps),
              static_cast<long long>(s.rejected));
  EXPECT_TRUE(s.finite);
  EXPECT_EQ(s.unsettled, 0);
  EXPECT_GT(s.weft_stretch_max, 0.0) << "no string was ever taut";
}

INSTANTIATE_TEST_SUITE_P(Sizes, DroppedSheet, ::testing::Values(std::pair{20, 20}, std::pair{44, 40}));

}  // namespace
}  // namespace curtain
