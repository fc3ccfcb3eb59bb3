// SPDX-License-Identifier: BSD-3-Clause
//
// What is exported here: a small cloth with folds in a wind, a ball that goes by, and a box that is not drawn.
#pragma once

#include <vector>

#include "curtain_sim/simulator.h"

namespace curtain_test {

inline curtain::Scene exportedScene(bool closed) {
  curtain::Scene scene;
  scene.cloth.rows = 8;
  scene.cloth.columns = 7;
  scene.cloth.folds = 3;
  scene.cloth.closed = closed;
  scene.cloth.height = 1.0;
  if (!closed) scene.cloth.slits = {{2, 4}};
  scene.hang.from = {0.0, 0.0, 2.0};
  scene.hang.to = {0.7, 0.0, 2.0};
  if (closed) scene.hang.radius = 0.1;
  curtain::WindParams wind;
  wind.id = "fan";
  wind.position = {0.3, -1.0, 1.5};
  wind.direction = {0.0, 1.0, 0.2};
  wind.pressure = 4.0;
  scene.wind.push_back(wind);
  curtain::ObstacleParams ball;
  ball.name = "ball";
  ball.shape = curtain::ShapeKind::kSphere;
  ball.radius = 0.1;
  ball.color = {0.5, 0.25, 0.0};
  ball.pose.position = {0.0, 0.5, 1.2};
  const curtain::Rotation turned(Eigen::AngleAxisd(2.0, curtain::Vec3::UnitZ()));
  ball.motion = {{0.0, ball.pose}, {1.0, {curtain::Vec3(0.5, 0.5, 1.2), turned}}};
  scene.obstacles.push_back(ball);
  curtain::ObstacleParams box = ball;
  box.name = "box";
  box.shape = curtain::ShapeKind::kBox;
  box.size = {0.1, 0.1, 0.1};
  box.visible = false;
  scene.obstacles.push_back(box);
  return scene;
}

/// Positions of the drawn vertices, row by row, of the mesh as a file would have it: closed cloth with its first column
/// again.
inline std::vector<curtain::Vec3> drawnPositions(const curtain::Simulator& simulator) {
  curtain::FineMesh mesh;
  simulator.copyFineMesh(mesh);
  const curtain::FineMeshTopology& topology = simulator.fineMeshTopology();
  const int drawn = topology.columns + (topology.closed ? 1 : 0);
  std::vector<curtain::Vec3> positions;
  for (int row = 0; row < topology.rows; ++row) {
    for (int column = 0; column < drawn; ++column)
      positions.push_back(mesh.positions[static_cast<std::size_t>(row * topology.columns + column % topology.columns)]);
  }
  return positions;
}

}  // namespace curtain_test
