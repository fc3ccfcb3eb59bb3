// SPDX-License-Identifier: BSD-3-Clause
//
// Small helpers of the tests: rounding units, scenes to start from, random numbers that are the same everywhere.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "cloth/cloth.h"
#include "drawn/choices.h"
#include "scene/pi.h"

namespace curtain_test {

constexpr double kEps = std::numeric_limits<double>::epsilon();  // two units of rounding of a number near one
using curtain::kPi;

/// Flat cloth of width x height [m] in the plane y = 0, its top row from (0, 0, height) along +x.
inline curtain::Scene flatScene(int rows, int columns, double height = 1.0, double width = 1.0) {
  curtain::Scene scene;
  scene.cloth.rows = rows;
  scene.cloth.columns = columns;
  scene.cloth.height = height;
  scene.cloth.width = width;
  scene.hang.from = {0.0, 0.0, height};
  scene.hang.to = {width, 0.0, height};
  return scene;
}

/// A cloth beside that of flatScene(), behind it by y [m].
inline curtain::LayerParams layerAt(const std::string& name, double y, int rows, int columns, double height,
                                    double width) {
  curtain::LayerParams layer;
  layer.name = name;
  const curtain::Scene scene = flatScene(rows, columns, height, width);
  layer.cloth = scene.cloth;
  layer.hang = scene.hang;
  layer.hang.from.y() += y;
  layer.hang.to.y() += y;
  return layer;
}

/// Closed cloth around the vertical through (0, 0, 2).
inline curtain::Scene ringScene(int rows, int columns, double height = 1.0, double width = 1.0) {
  curtain::Scene scene = flatScene(rows, columns, height, width);
  scene.cloth.closed = true;
  scene.hang.from = {0.0, 0.0, 2.0};
  return scene;
}

/// A source "fan" that blows along +y.
inline curtain::WindParams fanAt(const curtain::Vec3& position, double radius) {
  curtain::WindParams wind;
  wind.id = "fan";
  wind.position = position;
  wind.direction = curtain::Vec3::UnitY();
  wind.radius = radius;
  return wind;
}

inline curtain::ObstacleParams ballAt(const curtain::Vec3& position, double radius) {
  curtain::ObstacleParams ball;
  ball.name = "ball";
  ball.radius = radius;
  ball.pose.position = position;
  return ball;
}

/// A grid of nodes anywhere in a box.
inline curtain::Field3 randomPositions(const curtain::Grid& grid, Random& random, double half_edge) {
  curtain::Field3 position;
  position.assign(grid.size(), 0.0);
  for (std::size_t n = 0; n < grid.size(); ++n) position.set(n, random.inBox(half_edge));
  return position;
}

/// Moves every node that is free by up to `size` [m] in each direction.
inline void shake(const curtain::ClothPattern& pattern, double size, std::uint64_t seed, curtain::Field3& position) {
  Random random(seed);
  for (std::size_t n = 0; n < pattern.grid.size(); ++n) {
    const curtain::Vec3 step = random.inBox(size);
    if (pattern.inverse_mass[n] > 0.0) position.add(n, step);
  }
}

}  // namespace curtain_test
