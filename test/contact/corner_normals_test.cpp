// SPDX-License-Identifier: BSD-3-Clause
//
// Normals for drawing: boxes keep their edges, round shapes look round.
#include "obstacles/corner_normals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "curtain_sim/simulator.h"
#include "scene/pi.h"

namespace curtain {
namespace {

ShapeTriangles trianglesOf(ShapeKind kind) {
  Scene scene;
  scene.cloth.rows = scene.cloth.columns = 3;
  ObstacleParams obstacle;
  obstacle.name = "shape";
  obstacle.shape = kind;
  obstacle.radius = 0.3;
  obstacle.size = Vec3(0.4, 0.6, 0.2);
  obstacle.pose.position = Vec3(5.0, 0.0, 0.0);
  scene.obstacles.push_back(obstacle);
  return Simulator(scene).obstacleShape(0).triangles();
}

TEST(CornerNormals, CornersOfABoxHaveTheNormalsOfItsSides) {
  const std::vector<Vec3> normals = cornerNormals(trianglesOf(ShapeKind::kBox));
  ASSERT_EQ(normals.size(), 36u);
  for (const Vec3& normal : normals) {
    EXPECT_EQ(normal.cwiseAbs().maxCoeff(), 1.0) << normal.transpose();
    EXPECT_EQ(normal.norm(), 1.0) << normal.transpose();
  }
}

TEST(CornerNormals, NormalsOfASpherePointOutwardsFromItsCentre) {
  const ShapeTriangles sphere = trianglesOf(ShapeKind::kSphere);
  const std::vector<Vec3> normals = cornerNormals(sphere);
  ASSERT_EQ(normals.size(), 3 * sphere.triangles.size());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const int corner = sphere.triangles[i / 3][static_cast<int>(i % 3)];
    const Vec3 out = sphere.corners[static_cast<std::size_t>(corner)].normalized();
    // Facets of 48 around the axis are turned by 7.5 degrees; flat ones would be half of that off.
    EXPECT_GT(normals[i].dot(out), std::cos(0.5 * 7.5 * kPi / 180.0)) << i;
  }
}

}  // namespace
}  // namespace curtain
