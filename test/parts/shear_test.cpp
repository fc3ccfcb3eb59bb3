// SPDX-License-Identifier: BSD-3-Clause
//
// Shear and the wefts' push: their forces are the slopes of their energies and leave no momentum, a picture frame is
// pulled as the definition of the rigidity says, and no frequency is above the bound that steps follow.
#include "parts/shear/shear.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <string>
#include <vector>

#include "parts/weft_push/weft_push.h"
#include "scene/pi.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::kEps;
using curtain_test::Random;

constexpr double kRigidity = 20.0;  // [N/m]

struct Fabric {
  explicit Fabric(const Scene& given)
      : scene(given),
        pattern(makePattern(scene)),
        workers(1),
        shear(scene.cloth, pattern, workers),
        push(scene.cloth, pattern) {
    position.assign(pattern.grid.size(), 0.0);
    placeCloth(scene, pattern, position);
  }

  Scene scene;
  ClothPattern pattern;
  Field3 position;
  Workers workers;
  Shear shear;
  WeftPush push;
};

Scene sheared(Scene scene) {
  scene.cloth.shear = kRigidity;
  scene.cloth.bending_weft = scene.cloth.bending_warp = 1e-4;
  return scene;
}

Scene unevenScene(int rows, int columns, bool closed) {
  Scene scene = closed ? curtain_test::ringScene(rows, columns) : curtain_test::flatScene(rows, columns);
  Random random(7);
  for (int i = 0; i + 1 < rows; ++i) scene.cloth.row_spacing.push_back(random.between(0.5, 2.0));
  for (int j = 0; j + (closed ? 0 : 1) < columns; ++j) scene.cloth.column_spacing.push_back(random.between(0.5, 2.0));
  return sheared(scene);
}

Scene slitScene() {
  Scene scene = sheared(curtain_test::flatScene(9, 7));
  scene.cloth.slits = {{3, 4}};
  return scene;
}

// Rows enough for three blocks of them, where each adds to the next one's.
std::vector<Scene> scenes() {
  Scene tapered = sheared(curtain_test::flatScene(9, 6));
  tapered.cloth.hem_width = 0.7;
  return {unevenScene(18, 11, false), unevenScene(10, 9, true), tapered, slitScene(),
          sheared(curtain_test::flatScene(2, 2))};
}

void expectSlope(Fabric& fabric, ElasticPart& part) {
  Random random(3);
  const Grid& grid = fabric.pattern.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) fabric.position.add(grid.index(i, j), 0.03 * random.direction());
  }
  double energy = 0.0;
  const Field3 force = part.forceAt(fabric.position, energy);
  double largest = 0.0;
  Vec3 sum = Vec3::Zero(), turn = Vec3::Zero();
  for (std::size_t n = 0; n < grid.size(); ++n) {
    largest = std::max(largest, force.at(n).norm());
    sum += force.at(n);
    turn += fabric.position.at(n).cross(force.at(n));
  }
  ASSERT_GT(largest, 0.0);
  EXPECT_LT(sum.norm(), 1e3 * kEps * largest);
  EXPECT_LT(turn.norm(), 1e4 * kEps * largest);
  // Central differences: an error of third order in the step over lengths of some 0.1 m, and rounding over the step.
  constexpr double kStep = 1e-6;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      const Vec3 direction = random.direction();
      double before = 0.0, after = 0.0;
      Field3 moved = fabric.position;
      moved.add(n, kStep * direction);
      part.forceAt(moved, after);
      moved.add(n, -2.0 * kStep * direction);
      part.forceAt(moved, before);
      EXPECT_NEAR((before - after) / (2.0 * kStep), force.at(n).dot(direction), 1e-6 * largest) << i << ", " << j;
    }
  }
}

TEST(Shear, ForceIsTheEnergysSlopeAndLeavesNoMomentum) {
  for (const Scene& scene : scenes()) {
    Fabric fabric(scene);
    expectSlope(fabric, fabric.shear);
  }
}

TEST(WeftPush, ForceIsTheEnergysSlopeAndLeavesNoMomentum) {
  for (const Scene& scene : scenes()) {
    Fabric fabric(scene);
    expectSlope(fabric, fabric.push);
  }
}

// Flat cloth, tapered or not, is at rest.
TEST(Shear, FlatClothHasNone) {
  for (const Scene& scene : scenes()) {
    if (scene.cloth.closed) continue;  // it starts around, not flat
    Fabric fabric(scene);
    double energy = 0.0;
    const Field3& force = fabric.shear.forceAt(fabric.position, energy);
    EXPECT_NEAR(energy, 0.0, 1e-20);
    for (std::size_t n = 0; n < fabric.pattern.grid.size(); ++n) EXPECT_LT(force.at(n).norm(), 1e-12 * kRigidity);
  }
}

// Sheared by gamma at constant lengths the top row is pulled along by G W sin(gamma), and the energy is G A sin^2 / 2.
TEST(Shear, PullsAtAPictureFrameByItsRigidity) {
  Fabric fabric(sheared(curtain_test::flatScene(6, 9, 0.8, 1.3)));
  const Grid& grid = fabric.pattern.grid;
  for (const double gamma : {0.05, 0.3, -0.6}) {
    for (int i = 0; i < grid.rows; ++i) {
      for (int j = 0; j < grid.columns; ++j) {
        const double down = 0.8 * i / (grid.rows - 1);
        fabric.position.set(grid.index(i, j),
                            {1.3 * j / (grid.columns - 1) + down * std::sin(gamma), 0.0, -down * std::cos(gamma)});
      }
    }
    double energy = 0.0, pull = 0.0;
    const Field3& force = fabric.shear.forceAt(fabric.position, energy);
    for (int j = 0; j < grid.columns; ++j) pull += force.at(grid.index(0, j)).x();
    EXPECT_NEAR(pull, kRigidity * 1.3 * std::sin(gamma), 1e-12 * kRigidity);
    EXPECT_NEAR(energy, 0.5 * kRigidity * 0.8 * 1.3 * std::pow(std::sin(gamma), 2), 1e-12 * kRigidity);
  }
}

// Of the stiffness of flat cloth, by differences, over the masses.
TEST(Shear, NoFrequencyIsAboveItsBound) {
  for (const Scene& scene : {sheared(curtain_test::flatScene(7, 6)), unevenScene(7, 6, false)}) {
    Fabric fabric(scene);
    const Grid& grid = fabric.pattern.grid;
    const auto nodes = static_cast<Eigen::Index>(grid.nodeCount());
    std::vector<std::size_t> index;
    for (int i = 0; i < grid.rows; ++i) {
      for (int j = 0; j < grid.columns; ++j) index.push_back(grid.index(i, j));
    }
    Eigen::MatrixXd stiffness(3 * nodes, 3 * nodes);
    constexpr double kStep = 1e-6;
    for (Eigen::Index c = 0; c < 3 * nodes; ++c) {
      Field3 moved = fabric.position;
      moved.add(index[static_cast<std::size_t>(c / 3)], kStep * Vec3::Unit(c % 3));
      double energy = 0.0;
      const Field3& force = fabric.shear.forceAt(moved, energy);
      for (Eigen::Index r = 0; r < 3 * nodes; ++r) {
        const double mass = fabric.pattern.mass[index[static_cast<std::size_t>(r / 3)]] *
                            fabric.pattern.mass[index[static_cast<std::size_t>(c / 3)]];
        stiffness(r, c) = -force.at(index[static_cast<std::size_t>(r / 3)])[r % 3] / kStep / std::sqrt(mass);
      }
    }
    const double largest = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness).eigenvalues().maxCoeff();
    EXPECT_LE(largest, fabric.shear.omegaSquared() * (1.0 + 1e-6));
    EXPECT_GT(largest, 0.3 * fabric.shear.omegaSquared());
  }
}

// pi^2 B / l^2 for each metre of width, along the link: half of it for the first row, which is half as wide.
TEST(WeftPush, IsTheEulerLoadOfALink) {
  Fabric fabric(sheared(curtain_test::flatScene(5, 4, 0.8, 1.2)));
  double energy = 0.0;
  const Field3& force = fabric.push.forceAt(fabric.position, energy);
  EXPECT_NEAR(energy, 0.0, 1e-18);
  const double load = kPi * kPi * 1e-4 / (0.4 * 0.4);
  EXPECT_NEAR(force.at(fabric.pattern.grid.index(2, 0)).x(), -load * 0.2, 1e-12 * load);
  EXPECT_NEAR(force.at(fabric.pattern.grid.index(0, 3)).x(), load * 0.1, 1e-12 * load);
  EXPECT_NEAR(force.at(fabric.pattern.grid.index(2, 1)).norm(), 0.0, 1e-12 * load);
}

}  // namespace
}  // namespace curtain
