// SPDX-License-Identifier: BSD-3-Clause
//
// The order of every scheme: how its error on the chain of 43 rods after a second goes down with the step, and what is
// left of it where rounding takes over.
#include <gtest/gtest.h>

#include <cstdio>
#include <vector>

#include "simulator/chains.h"

namespace curtain {
namespace {

using curtain_test::chainErrorAfterASecond;
using curtain_test::chainScene;

struct Order {
  const char* name;
  Method method;
  std::vector<int> substeps;  // each twice the one before
  double ratio;               // of the errors of neighbours
  double within;              // relative
};

class SchemeOrder : public ::testing::TestWithParam<Order> {};

// Halving the step divides the error of positions by 2^order. What the ratio may be off is the next term of the error's
// expansion over the first; omega: of the fastest mode, 190 / s by Gershgorin's bound for the hanging chain.
//   leapfrog   even terms only: (h omega)^2 / 12 = 0.013 at 8 substeps; 10 %
//   leapfrog4  the same with its longest stage, 0.66 h: 0.09 at 2 substeps, twice that for its five stages; 20 %
//   implicit   next term h omega, with the modes that carry the motion (below 50 / s), at 32 substeps, where it damps
//              all that is faster; 10 %
TEST_P(SchemeOrder, IsTheOneItClaims) {
  const Order& order = GetParam();
  double last = 0.0;
  for (const int substeps : order.substeps) {
    const double error = chainErrorAfterASecond(chainScene(43), order.method, substeps).position;
    std::printf("%-10s %3d substeps: %.3e m, ratio %.3f\n", order.name, substeps, error, last / error);
    if (last > 0.0) {
      EXPECT_NEAR(last / error, order.ratio, order.within * order.ratio) << substeps << " substeps";
    }
    last = error;
  }
}

INSTANTIATE_TEST_SUITE_P(Schemes, SchemeOrder,
                         ::testing::Values(Order{"leapfrog", Method::kLeapfrog, {8, 16, 32}, 4.0, 0.1},
                                           Order{"leapfrog4", Method::kLeapfrog4, {2, 4, 8}, 16.0, 0.2},
                                           Order{"implicit", Method::kImplicit, {32, 64}, 2.0, 0.1}),
                         [](const auto& test) { return std::string(test.param.name); });

// Velocities are of order 2 as well, though leapfrog keeps them half a step behind. They hold more of the fast modes
// than positions do: 15 %.
TEST(Order, LeapfrogsVelocitiesAreOfSecondOrder) {
  const double coarse = chainErrorAfterASecond(chainScene(43), Method::kLeapfrog, 8).velocity;
  const double fine = chainErrorAfterASecond(chainScene(43), Method::kLeapfrog, 16).velocity;
  EXPECT_NEAR(coarse / fine, 4.0, 0.6);
}

class Leapfrog4 : public ::testing::TestWithParam<int> {};

// At 64 substeps leapfrog4 is exact but for rounding. The step leaves 1e-3 m / 64^4 = 6e-11 m. Rounding: a stage rounds
// positions of up to 2 m to 2^-53 of that, which is an error of the velocity for all stages after it: at worst, all to
// one side, n^2 / 2 * 2 m * 2^-53 = 4.1e-8 m with n = 60 * 64 * 5.
TEST_P(Leapfrog4, IsExactToRoundingAt64Substeps) {
  const double error = chainErrorAfterASecond(chainScene(GetParam()), Method::kLeapfrog4, 64).position;
  std::printf("leapfrog4, %d rods, 64 substeps: %.2e m\n", GetParam(), error);
  EXPECT_LE(error, 4.2e-8);
}

INSTANTIATE_TEST_SUITE_P(Rods, Leapfrog4, ::testing::Values(1, 2, 5, 10));

}  // namespace
}  // namespace curtain
