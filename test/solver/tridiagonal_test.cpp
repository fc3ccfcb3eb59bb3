// SPDX-License-Identifier: BSD-3-Clause
//
// The tridiagonal solver gives what a dense solver gives, open and cyclic.
#include "solver/tridiagonal.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace curtain {
namespace {

// Diagonally dominant by a factor of at least 1.5, so the condition number is below 10 and a backward stable solve
// errs by less than about 10 * count * epsilon < 1e-13.
constexpr double kTolerance = 1e-13;

void compareWithDense(std::size_t count, bool cyclic, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> off(-1.0, 0.5);
  TridiagonalSystem system(count + 3);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(count));
  Eigen::VectorXd rhs(static_cast<Eigen::Index>(count));
  const auto n = static_cast<Eigen::Index>(count);
  for (Eigen::Index p = 0; p < n; ++p) {
    const auto at = static_cast<std::size_t>(p);
    system.lower[at] = off(random);
    system.upper[at] = off(random);
    system.diagonal[at] = 3.0 + off(random);
    rhs[p] = system.rhs[at] = off(random);
    matrix(p, p) = system.diagonal[at];
    if (p > 0 || cyclic) matrix(p, (p + n - 1) % n) += system.lower[at];
    if (p + 1 < n || cyclic) matrix(p, (p + 1) % n) += system.upper[at];
  }
  ASSERT_TRUE(system.solve(count, cyclic));
  const Eigen::VectorXd expected = matrix.partialPivLu().solve(rhs);
  for (Eigen::Index p = 0; p < n; ++p) {
    EXPECT_NEAR(system.rhs[static_cast<std::size_t>(p)], expected[p], kTolerance) << "unknown " << p << " of " << n;
  }
}

TEST(TridiagonalSystem, AgreesWithDenseSolverOpen) {
  for (const std::size_t count : {1U, 2U, 3U, 17U, 100U}) compareWithDense(count, false, 7U + unsigned(count));
}

TEST(TridiagonalSystem, AgreesWithDenseSolverCyclic) {
  for (const std::size_t count : {3U, 4U, 17U, 100U}) compareWithDense(count, true, 11U + unsigned(count));
}

TEST(TridiagonalSystem, VanishingPivotLeavesItsUnknownZeroAndIsReported) {
  TridiagonalSystem system(2);
  system.diagonal = {0.0, 2.0};
  system.rhs = {1.0, 4.0};
  EXPECT_FALSE(system.solve(2, false));
  EXPECT_EQ(system.rhs[0], 0.0);
  EXPECT_EQ(system.rhs[1], 2.0);
}

}  // namespace
}  // namespace curtain
