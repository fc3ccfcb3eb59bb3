// SPDX-License-Identifier: BSD-3-Clause
//
// Cloths of all shapes for the tests of elastic parts, and what every such part must do: its force is the slope of its
// energy and leaves no momentum, and no frequency is above the bound that steps follow.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "cloth/cloth.h"
#include "cloth/workers.h"
#include "curtain_sim/scene.h"
#include "step/elastic_part.h"
#include "testing.h"

namespace curtain_test {

using curtain::ElasticPart;
using curtain::Field3;
using curtain::Grid;
using curtain::Scene;
using curtain::Vec3;

/// A scene's cloth at its start.
struct Fabric {
  explicit Fabric(const Scene& given) : scene(given), pattern(makePattern(scene)), workers(1) {
    position.assign(pattern.grid.size(), 0.0);
    placeCloth(scene, pattern, position);
  }

  Scene scene;
  curtain::ClothPattern pattern;
  Field3 position;
  curtain::Workers workers;
};

/// Open or closed cloth whose rows and columns lie unevenly.
inline Scene unevenScene(int rows, int columns, bool closed) {
  Scene scene = closed ? ringScene(rows, columns) : flatScene(rows, columns);
  Random random(7);
  for (int i = 0; i + 1 < rows; ++i) scene.cloth.row_spacing.push_back(random.between(0.5, 2.0));
  for (int j = 0; j + (closed ? 0 : 1) < columns; ++j) scene.cloth.column_spacing.push_back(random.between(0.5, 2.0));
  return scene;
}

/// Rows enough for three blocks of them, where each adds to the next one's.
inline std::vector<Scene> fabricScenes() {
  Scene tapered = flatScene(9, 6), slit = flatScene(9, 7);
  tapered.cloth.hem_width = 0.7;
  slit.cloth.slits = {{3, 4}};
  std::vector<Scene> scenes{unevenScene(18, 11, false), unevenScene(10, 9, true), tapered, slit, flatScene(3, 3)};
  for (Scene& scene : scenes) scene.cloth.bending_weft = scene.cloth.bending_warp = 1e-4;
  return scenes;
}

inline void expectSlope(const Fabric& fabric, ElasticPart& part) {
  const Grid& grid = fabric.pattern.grid;
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
  Random random(5);
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

/// Largest square of a frequency at these positions [1/s^2], of the stiffness by differences over the masses.
inline double largestOmegaSquared(const Fabric& fabric, ElasticPart& part) {
  const Grid& grid = fabric.pattern.grid;
  const auto nodes = static_cast<Eigen::Index>(grid.nodeCount());
  std::vector<std::size_t> index;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) index.push_back(grid.index(i, j));
  }
  Eigen::MatrixXd stiffness(3 * nodes, 3 * nodes);
  constexpr double kStep = 1e-6;
  double energy = 0.0;
  const Field3 at_start = part.forceAt(fabric.position, energy);
  for (Eigen::Index c = 0; c < 3 * nodes; ++c) {
    Field3 moved = fabric.position;
    moved.add(index[static_cast<std::size_t>(c / 3)], kStep * Vec3::Unit(c % 3));
    const Field3& force = part.forceAt(moved, energy);
    for (Eigen::Index r = 0; r < 3 * nodes; ++r) {
      const std::size_t row = index[static_cast<std::size_t>(r / 3)], column = index[static_cast<std::size_t>(c / 3)];
      const double mass = fabric.pattern.mass[row] * fabric.pattern.mass[column];
      stiffness(r, c) = (at_start.at(row)[r % 3] - force.at(row)[r % 3]) / kStep / std::sqrt(mass);
    }
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness).eigenvalues().maxCoeff();
}

}  // namespace curtain_test
