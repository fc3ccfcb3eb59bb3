// SPDX-License-Identifier: BSD-3-Clause
//
// Lines that resist bending against the same written out with dense matrices: A = K (1 + D K)^-1, K = C^T k C.
#include "parts/bending/bending.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <string>
#include <vector>

#include "parts/bending/bending_lines.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::Random;

constexpr double kRigidity = 2e-4;  // [N m]

// Uneven lengths and masses, some pins; two pins side by side along either direction are clamps.
ClothPattern unevenPattern(int rows, int columns, bool closed) {
  Scene scene = closed ? curtain_test::ringScene(rows, columns) : curtain_test::flatScene(rows, columns);
  Random random(7);
  for (int i = 0; i + 1 < rows; ++i) scene.cloth.row_spacing.push_back(random.between(0.5, 2.0));
  for (int j = 0; j + (closed ? 0 : 1) < columns; ++j) scene.cloth.column_spacing.push_back(random.between(0.5, 2.0));
  for (int i = 0; i < rows; ++i) scene.cloth.row_mass.push_back(random.between(0.5, 2.0));
  scene.cloth.bending_warp = kRigidity;
  scene.cloth.bending_weft = 3.0 * kRigidity;
  scene.pins.kind = PinKind::kList;
  scene.pins.nodes = {{0, 0}, {1, 0}, {rows - 1, columns - 1}, {0, 1}};
  return makePattern(scene);
}

// The nodes of a line, in order.
std::vector<std::size_t> lineOf(const Grid& grid, bool warp, int number) {
  std::vector<std::size_t> nodes;
  const int count = warp ? grid.rows : grid.columns;
  for (int i = 0; i < count; ++i) nodes.push_back(warp ? grid.index(i, number) : grid.index(number, i));
  return nodes;
}

Eigen::MatrixXd matrixOf(const ClothPattern& pattern, bool warp, int number, const Field* give) {
  const std::vector<std::size_t> nodes = lineOf(pattern.grid, warp, number);
  const auto count = static_cast<Eigen::Index>(nodes.size());
  const Field& rest = warp ? pattern.warp_rest : pattern.weft_rest;
  const Field& stiffness = warp ? pattern.warp_bending : pattern.weft_bending;
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(count, count), give_way = k, turns = k;
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto here = static_cast<std::size_t>(i), after = static_cast<std::size_t>((i + 1) % count);
    k(i, i) = stiffness[nodes[here]];
    if (give != nullptr) give_way(i, i) = (*give)[nodes[here]];
    turns(i, (i + count - 1) % count) += 1.0 / rest[nodes[here]];
    turns(i, i) -= 1.0 / rest[nodes[here]] + 1.0 / rest[nodes[after]];
    turns(i, (i + 1) % count) += 1.0 / rest[nodes[after]];
  }
  const Eigen::MatrixXd full = turns.transpose() * k * turns;
  return full * (Eigen::MatrixXd::Identity(count, count) + give_way * full).inverse();
}

// Largest difference between a direction's forces and the dense ones, over the largest force.
double differenceFrom(const ClothPattern& pattern, bool warp, const Field* give, const Field3& position,
                      const Field3& force) {
  double worst = 0.0, largest = 0.0;
  for (int line = 0; line < (warp ? pattern.grid.columns : pattern.grid.rows); ++line) {
    const std::vector<std::size_t> nodes = lineOf(pattern.grid, warp, line);
    Eigen::MatrixXd x(static_cast<Eigen::Index>(nodes.size()), 3);
    for (std::size_t i = 0; i < nodes.size(); ++i) x.row(static_cast<Eigen::Index>(i)) = position.at(nodes[i]);
    const Eigen::MatrixXd expected = -matrixOf(pattern, warp, line, give) * x;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Vec3 wanted = expected.row(static_cast<Eigen::Index>(i));
      worst = std::max(worst, (force.at(nodes[i]) - wanted).norm());
      largest = std::max(largest, wanted.norm());
    }
  }
  return largest > 0.0 ? worst / largest : worst;
}

struct Shape {
  int rows, columns;
  bool closed;
};

void PrintTo(const Shape& shape, std::ostream* out) {
  *out << shape.rows << " x " << shape.columns << (shape.closed ? ", closed" : "");
}

// Of the link on the left of a node.
std::size_t startOf(const Grid& grid, int row, int column) {
  return grid.index(row, column > 0 ? column - 1 : grid.columns - 1);
}

// The force that has a potential: with what was spared.
Field3 withSpared(const Grid& grid, const Field3& force, const Field3& spared) {
  Field3 all = force;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      all.add(grid.index(i, j), -spared.at(grid.index(i, j)));
      all.add(startOf(grid, i, j), spared.at(grid.index(i, j)));
    }
  }
  return all;
}

class BendingLines_ : public ::testing::TestWithParam<Shape> {
 protected:
  BendingLines_()
      : pattern_(unevenPattern(GetParam().rows, GetParam().columns, GetParam().closed)),
        position_(curtain_test::randomPositions(pattern_.grid, random_, 1.0)) {
    for (Field3* field : {&force_, &nothing_, &shears_.q, &shears_.spared}) field->assign(pattern_.grid.size(), 0.0);
    give_.assign(pattern_.grid.size(), 0.0);
    scratch_.assign(pattern_.grid);
    for (double& one : give_) one = random_.between(-1.0, 1.0) > 0.0 ? 10.0 * random_.between(0.0, 1.0) : 0.0;
  }
  Field3 withSpared() const { return curtain::withSpared(pattern_.grid, force_, shears_.spared); }
  // How hard the shears that are left press a link together, of all that they are; and what is spared of a link that
  // is not pressed, or across it.
  double maxPress() const {
    double worst = 0.0;
    for (int i = 0; i < pattern_.grid.rows; ++i) {
      for (int j = 0; j < pattern_.grid.columns; ++j) {
        const std::size_t n = pattern_.grid.index(i, j);
        const double share =
            (position_.at(n) - position_.at(startOf(pattern_.grid, i, j))).norm() / pattern_.weft_rest[n];
        if (share < 0.99 && !shears_.spared.at(n).isZero()) return 1.0;  // slack
        if (share < 1.0) continue;
        const Vec3 way = (position_.at(n) - position_.at(startOf(pattern_.grid, i, j))).normalized(),
                   spared = shears_.spared.at(n);
        const double all = (shears_.q.at(n) + spared).norm() + 1e-300;
        worst =
            std::max({worst, shears_.q.at(n).dot(way) / all, -spared.dot(way) / all, spared.cross(way).norm() / all});
        if (!spared.isZero()) worst = std::max(worst, std::abs(shears_.q.at(n).dot(way)) / all);
      }
    }
    return worst;
  }
  int blocks() const { return pattern_.grid.stride / kLane; }

  Random random_{1};
  const ClothPattern pattern_;
  const Field3 position_;
  Field3 force_, nothing_;
  Field give_;
  BendingScratch scratch_;
  WeftShears shears_;
};

// Bound: the dense solution's own rounding, some ten operations deep; matrices have condition numbers below 1e4.
constexpr double kEnergyRounding = 1e-11;

TEST_P(BendingLines_, WarpExertsMinusKx) {
  const BendingLines lines = warpLines(pattern_);
  for (int b = 0; b < blocks(); ++b) bendWarp(pattern_.grid, lines, nothing_, position_, b, force_);
  EXPECT_LT(differenceFrom(pattern_, true, nullptr, position_, force_), kEnergyRounding);
}

TEST_P(BendingLines_, WeftExertsMinusKx) {
  const BendingLines lines = weftLines(pattern_);
  for (int b = 0; b < (pattern_.grid.rows + kLane - 1) / kLane; ++b)
    bendWeft(pattern_.grid, lines, position_, b, shears_, force_);
  EXPECT_LT(differenceFrom(pattern_, false, nullptr, position_, withSpared()), kEnergyRounding);
  EXPECT_LT(maxPress(), kEnergyRounding);
  for (int i = 0; i < pattern_.grid.rows; ++i) {
    for (int j = 0; j < pattern_.grid.columns; ++j) {
      const Vec3 one = weftBendingAt(pattern_.grid, lines, position_, i, j);
      EXPECT_LT((one - force_.at(pattern_.grid.index(i, j))).norm(), kEnergyRounding * (1.0 + one.norm()));
    }
  }
}

TEST_P(BendingLines_, WarpThatGivesWayIsInSeriesWithItsNodes) {
  const BendingLines lines = warpLines(pattern_);
  for (int b = 0; b < blocks(); ++b) bendWarpGiving(pattern_.grid, lines, give_, position_, b, scratch_, force_);
  EXPECT_LT(differenceFrom(pattern_, true, &give_, position_, force_), kEnergyRounding);
}

TEST_P(BendingLines_, WeftThatGivesWayIsInSeriesWithItsNodes) {
  const BendingLines lines = weftLines(pattern_);
  for (int b = 0; b < (pattern_.grid.rows + kLane - 1) / kLane; ++b)
    bendWeftGiving(pattern_.grid, lines, give_, position_, b, scratch_, true, shears_, force_);
  EXPECT_LT(differenceFrom(pattern_, false, &give_, position_, withSpared()), kEnergyRounding);
  EXPECT_LT(maxPress(), kEnergyRounding);
}

TEST_P(BendingLines_, BoundIsAboveTheMatrix) {
  for (const bool warp : {true, false}) {
    const BendingLines lines = warp ? warpLines(pattern_) : weftLines(pattern_);
    for (int line = 0; line < (warp ? pattern_.grid.columns : pattern_.grid.rows); ++line) {
      const std::vector<std::size_t> nodes = lineOf(pattern_.grid, warp, line);
      Eigen::MatrixXd rest = -matrixOf(pattern_, warp, line, nullptr);
      for (std::size_t i = 0; i < nodes.size(); ++i)
        rest(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) += lines.bound[nodes[i]];
      EXPECT_GE(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(rest).eigenvalues().minCoeff(),
                -1e-12 * lines.bound[nodes[0]]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, BendingLines_,
                         ::testing::Values(Shape{12, 9, false}, Shape{3, 3, false}, Shape{2, 2, false},
                                           Shape{9, 17, false}, Shape{4, 3, true}, Shape{4, 4, true}, Shape{4, 5, true},
                                           Shape{10, 16, true}));

// What a substep bears, of what leapfrog does: scale A W has no eigenvalue above the limit, however stiff the cloth is,
// with both directions and the links' tensions.
TEST(Bending, StaysWithinWhatTheStepBears) {
  const ClothPattern pattern = [] {
    Scene scene = curtain_test::flatScene(9, 7);
    scene.cloth.bending_warp = 1e2;
    scene.cloth.bending_weft = 1.0;
    scene.cloth.row_mass = {1, 1, 3, 1, 0.2, 1, 1, 1, 5};
    scene.pins.kind = PinKind::kTopCorners;
    return makePattern(scene);
  }();
  const Workers workers(1);
  NodeInertia inertia(pattern);
  Bending bending(pattern, workers);
  const Grid& grid = pattern.grid;
  const double scale = 1e-4;
  // Half of what leapfrog bears is taken by tensions, at some nodes.
  NodeInertia::Tensions& tensions = inertia.tensions();
  tensions.scale = scale;
  for (int j = 0; j < grid.columns; ++j) tensions.load[grid.index(4, j)] = pattern.mass[grid.index(4, j)];
  tensions.heaviest = 1.0;
  for (const bool explicit_links : {true, false}) {
    bending.begin(inertia, inertia.inverse(), scale, explicit_links);
    const auto count = static_cast<Eigen::Index>(grid.nodeCount());
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(count, count);
    Field3 unit;
    const auto at = [&](Eigen::Index n) {
      return grid.index(static_cast<int>(n) / grid.columns, static_cast<int>(n) % grid.columns);
    };
    for (Eigen::Index n = 0; n < count; ++n) {
      unit.assign(grid.size(), 0.0);
      unit.x[at(n)] = 1.0;
      double energy = 0.0;
      const Field3 force = withSpared(grid, bending.forceAt(unit, energy), bending.spared());
      for (Eigen::Index m = 0; m < count; ++m)
        a(m, n) = -scale * force.x[at(m)] * std::sqrt(pattern.inverse_mass[at(m)] * pattern.inverse_mass[at(n)]);
    }
    EXPECT_LT((a - a.transpose()).norm(), 1e-9 * a.norm());
    if (explicit_links) {
      for (Eigen::Index n = 0; n < count; ++n) a(n, n) += 2.0 * tensions.load[at(n)] * pattern.inverse_mass[at(n)];
    }
    const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a).eigenvalues();
    EXPECT_LE(eigenvalues.maxCoeff(), (explicit_links ? 3.61 : 1.0) * (1.0 + 1e-9));
    EXPECT_GT(eigenvalues.maxCoeff(), explicit_links ? 2.0 : 0.6);
    EXPECT_GE(eigenvalues.minCoeff(), -1e-9);
  }
}

// A pattern whose joints all turn at rest, by angles of both signs.
ClothPattern curvedPattern(bool closed) {
  ClothPattern pattern = unevenPattern(6, 7, closed);
  Random random(3);
  for (Field* turn : {&pattern.warp_rest_turn, &pattern.weft_rest_turn}) {
    turn->assign(pattern.grid.size(), 0.0);
    for (double& angle : *turn) angle = random.between(-1.2, 1.2);
  }
  return pattern;
}

// Any positions, with lines that give way and that do not: the force is the energy's slope, and leaves neither momentum
// nor angular momentum to the cloth.
TEST(RestCurvature, ForcesAreTheSlopeOfTheEnergyAndBalance) {
  for (const double scale : {1e-12, 10.0}) {
    for (const bool closed : {false, true}) {
      const ClothPattern pattern = curvedPattern(closed);
      const Workers workers(1);
      NodeInertia inertia(pattern);
      Bending bending(pattern, workers);
      bending.begin(inertia, inertia.inverse(), scale, true);
      EXPECT_EQ(bending.gives(), scale > 1e-6);
      Random random(5);
      Field3 position = makeInitialState(
                            [&] {
                              Scene scene = closed ? curtain_test::ringScene(6, 7) : curtain_test::flatScene(6, 7);
                              return scene;
                            }(),
                            pattern)
                            .position;
      for (std::size_t n = 0; n < pattern.grid.size(); ++n) position.add(n, random.inBox(0.02));
      double energy = 0.0, nearby = 0.0;
      const Field3 exerted = bending.forceAt(position, energy),
                   force = withSpared(pattern.grid, exerted, bending.spared());
      Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
      double largest = 0.0;
      for (std::size_t n = 0; n < pattern.grid.size(); ++n) {
        sum += exerted.at(n);
        torque += position.at(n).cross(exerted.at(n));
        largest = std::max(largest, force.at(n).norm());
      }
      EXPECT_LT(sum.norm(), 1e-12 * largest);
      EXPECT_LT(torque.norm(), 1e-11 * largest);
      // Central differences: error of third order in the step, over lengths of some 0.1 m, and rounding over the step.
      constexpr double kStep = 1e-5;
      for (int i = 0; i < pattern.grid.rows; ++i) {
        for (int j = 0; j < pattern.grid.columns; ++j) {
          const std::size_t n = pattern.grid.index(i, j);
          const Vec3 direction = random.direction();
          Field3 moved = position;
          moved.add(n, kStep * direction);
          bending.forceAt(moved, energy);
          moved.add(n, -2.0 * kStep * direction);
          bending.forceAt(moved, nearby);
          EXPECT_NEAR((nearby - energy) / (2.0 * kStep), force.at(n).dot(direction), 1e-6 * largest) << i << ", " << j;
        }
      }
    }
  }
}

// Cloth that starts in pressed pleats stays in them.
TEST(RestCurvature, HoldsPressedPleatsWhereTheyStart) {
  Scene scene = curtain_test::flatScene(5, 25, 1.0, 2.0);
  scene.cloth.bending_weft = kRigidity;
  scene.hang.to = scene.hang.from + Vec3(1.2, 0.0, 0.0);
  scene.hang.heading = Heading::kRipple;
  double energy[2] = {};
  for (const double pressed : {0.0, 1.0}) {
    scene.hang.pressed = pressed;
    ASSERT_TRUE(validate(scene).empty()) << describe(validate(scene));
    const ClothPattern pattern = makePattern(scene);
    const Workers workers(1);
    NodeInertia inertia(pattern);
    Bending bending(pattern, workers);
    bending.begin(inertia, inertia.inverse(), 1e-12, true);
    bending.forceAt(makeInitialState(scene, pattern).position, energy[pressed > 0.0]);
  }
  EXPECT_GT(energy[0], kRigidity);
  EXPECT_LT(std::abs(energy[1]), 1e-10 * energy[0]);
}

// A line bent by its rest turn at each joint has no energy, and turns no rod: what is left runs along the rods, which
// are at their lengths. Bent further or less it has the energy of its joints.
TEST(RestCurvature, IsAtRestWhereItsTurnsAre) {
  constexpr double kTurn = 0.3, kRod = 0.1;
  Scene scene = curtain_test::flatScene(6, 3, 5 * kRod, 2 * kRod);
  scene.cloth.bending_warp = kRigidity;
  scene.pins.kind = PinKind::kNone;
  ClothPattern pattern = makePattern(scene);
  pattern.warp_rest_turn.assign(pattern.grid.size(), kTurn);
  const Workers workers(1);
  NodeInertia inertia(pattern);
  Bending bending(pattern, workers);
  Field3 position = makeInitialState(scene, pattern).position;
  const auto bend = [&](double turn) {
    for (int j = 0; j < 3; ++j) {
      Vec3 at(kRod * j, 0.0, 0.0);
      for (int i = 0; i < 6; ++i) {
        position.set(pattern.grid.index(i, j), at);
        // Turned by `turn` from rod to rod, about the weft's direction x.
        at += kRod * Vec3(0.0, std::cos(turn * i), std::sin(turn * i));
      }
    }
  };
  double energy = 0.0;
  bending.begin(inertia, inertia.inverse(), 1e-12, true);
  bend(kTurn);
  const Field3 force = bending.forceAt(position, energy);
  EXPECT_NEAR(energy, 0.0, 1e-12 * kRigidity);
  for (int rod = 1; rod < 6; ++rod) {
    const Vec3 across(0.0, -std::sin(kTurn * (rod - 1)), std::cos(kTurn * (rod - 1)));
    double turns = 0.0;
    for (int i = rod; i < 6; ++i) {
      for (int j = 0; j < 3; ++j) turns += force.at(pattern.grid.index(i, j)).dot(across);
    }
    EXPECT_NEAR(turns, 0.0, 1e-10 * kRigidity / kRod) << rod;
  }
  for (const double turn : {0.2, 0.4}) {
    bend(turn);
    bending.forceAt(position, energy);
    // k = B width / l: the columns are as wide as two rods are long, four joints each.
    EXPECT_NEAR(energy, 4 * 2.0 * kRigidity * (1.0 - std::cos(turn - kTurn)), 1e-10 * kRigidity) << turn;
  }
}

}  // namespace
}  // namespace curtain
