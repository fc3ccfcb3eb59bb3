// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth at rest: that nothing moves stays where it is, and hanging cloth comes to the same shape whichever way it came.
#include <gtest/gtest.h>

#include <string>

#include "properties/growth.h"
#include "properties/kinds.h"
#include "properties/seeds.h"

namespace curtain {
namespace {

using namespace curtain_test;

class AtRest : public ::testing::TestWithParam<Method> {};

// Without gravity. Where every length is a number to the last bit nothing ever moves, to the bit.
TEST_P(AtRest, NothingMovesByItself) {
  Scene scene = flatScene(9, 5, 2.0, 1.0);
  scene.gravity.setZero();
  scene.solver.method = GetParam();
  scene.air.inside = scene.air.border = 0.1;
  EXPECT_EQ(farthestGone(record(scene, 100)), 0.0);
}

// Else rods begin off their lengths by rounding, which Newton takes out: what is left is what rounding may give n steps
// of velocity (order_test.cpp), n^2 / 2 * 2^-53 of the coordinates, 5 m.
TEST_P(AtRest, NothingMovesByMoreThanRounding) {
  for (const bool taut : {false, true}) {
    for (const std::uint64_t seed : seeds(3)) {
      Wanted wanted;
      wanted.taut = taut;
      wanted.damped = seed % 2 == 0;
      Scene scene = randomScene(seed, wanted);
      scene.gravity.setZero();
      scene.solver.method = GetParam();
      const Motion motion = record(scene, 100);
      const double steps =
          static_cast<double>(motion.statistics.substeps) * (GetParam() == Method::kLeapfrog4 ? 5.0 : 1.0);
      EXPECT_LE(farthestGone(motion), 0.5 * steps * steps * 0.5 * kEps * 5.0) << repeat(seed);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, AtRest, kEveryMethod, nameOfMethod);

class Equilibrium : public ::testing::TestWithParam<Method> {};

// Gathered cloth let go from two sides, in air thick enough to stop it, hangs straight down in the end, in gravity that
// need not be plumb. Fifteen seconds: the slowest mode of 1.6 m, at critical damping (c / m = 4 / s above 2 omega = 6 /
// s at most), dies by e^-30 of 2 m. Left is what the links' tolerance of 1e-3 leaves of 1.6 m: 1.6 mm.
TEST_P(Equilibrium, DoesNotDependOnTheWayThere) {
  for (const std::uint64_t seed : seeds(2)) {
    Wanted wanted;
    Scene scene = randomScene(seed, wanted);
    scene.solver.method = GetParam();
    scene.cloth.lumping = Lumping::kUniform;
    scene.cloth.row_mass.clear();
    scene.cloth.column_mass.clear();
    scene.air.density = 1.0;
    scene.air.inside = scene.air.border = scene.air.corner = 4.0 * scene.cloth.surface_density;
    Scene other = scene;
    other.hang.tilt = -0.7 * scene.hang.tilt + 0.4;
    const Motion one = record(scene, 900), two = record(other, 900);
    const double height = scene.cloth.height;
    const auto last = static_cast<std::size_t>((one.rows - 1) * one.columns);
    for (std::size_t j = 0; j < static_cast<std::size_t>(one.columns); ++j) {
      const Vec3 hangs = one.positions[0][j] + height * scene.gravity.normalized();
      EXPECT_LE((one.positions.back()[last + j] - hangs).norm(), 1e-3 * height) << repeat(seed) << ", column " << j;
      EXPECT_LE((two.positions.back()[last + j] - hangs).norm(), 1e-3 * height) << repeat(seed) << ", column " << j;
    }
    EXPECT_GT((one.positions[0][last] - two.positions[0][last]).norm(), 0.1 * height) << repeat(seed);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Equilibrium, kEveryMethod, nameOfMethod);

}  // namespace
}  // namespace curtain
