// SPDX-License-Identifier: BSD-3-Clause
//
// Sheets drawn nearly straight between two corners. Their strings pull many times the weight, in short substeps, and
// hang so flat that what a link lacks comes out ten times as large across them. At its full width a row cannot sag at
// all but by what its links give.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "curtain_sim/simulator.h"
#include "figures.h"

namespace curtain {
namespace {

class TautSheet : public ::testing::TestWithParam<double> {};

// Air takes speed at 1.2 / s: of the fall, some 3 m/s, 15 s leave 5e-8 m/s. What is left over in a substep is more, a
// share of 0.3 (kShareOfWeight) of what weight does in it, if it did not sleep.
TEST_P(TautSheet, ComesToRest) {
  Scene scene;
  scene.cloth.rows = scene.cloth.columns = 24;
  scene.cloth.height = scene.cloth.width = 1.0;
  scene.cloth.surface_density = 0.2;
  scene.hang.from = Vec3(0.0, 0.0, 2.0);
  scene.hang.to = Vec3(GetParam(), 0.0, 2.0);
  scene.pins.kind = PinKind::kTopCorners;
  scene.air.inside = scene.air.border = scene.air.corner = 0.2;
  Simulator simulator(scene);
  double substeps = 0.0, frames = 0.0;  // awake
  for (int frame = 0; frame < 15 * 60; ++frame) {
    simulator.step();
    if (simulator.statistics().asleep) continue;
    substeps += simulator.statistics().substeps_last;
    ++frames;
  }
  std::vector<Vec3> velocity;
  simulator.copyVelocities(velocity);
  double fastest = 0.0;
  for (const Vec3& v : velocity) fastest = std::max(fastest, v.norm());
  const Statistics& s = simulator.statistics();
  const double substep = 1.0 / (scene.solver.frame_rate * std::max(1, s.substeps_last));
  EXPECT_LE(fastest, 0.3 * scene.gravity.norm() * substep);
  const bool sags = GetParam() < 0.9999;
  curtain_test::keepFigure(sags ? "taut sheet, substeps a frame" : "sheet at its full width, substeps a frame",
                           substeps / frames);
  EXPECT_LT(substeps / frames, sags ? 20.0 : 50.0) << "links were shaken all the time";
  // At its full width it moved by nothing else, and for ever, while wefts gave by another law in every substep.
  const double share = static_cast<double>(s.last_resort_substeps) / static_cast<double>(s.substeps);
  curtain_test::keepFigure("taut sheet, share of the last resort", share);
  EXPECT_LE(share, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Widths, TautSheet, ::testing::Values(0.93, 0.96, 0.98, 0.99, 0.999, 0.9999, 1.0));

}  // namespace
}  // namespace curtain
