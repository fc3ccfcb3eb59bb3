// SPDX-License-Identifier: BSD-3-Clause
//
// Light on obstacles: boxes keep their edges, round shapes look round, what faces the light is brighter. No ROS master
// needed.
#include "ros/outputs/shape_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "curtain_sim/simulator.h"
#include "scene/pi.h"

namespace curtain_ros {
namespace {

using curtain::Vec3;

curtain::ShapeTriangles trianglesOf(curtain::ShapeKind kind) {
  curtain::Scene scene;
  scene.cloth.rows = scene.cloth.columns = 3;
  curtain::ObstacleParams obstacle;
  obstacle.name = "shape";
  obstacle.shape = kind;
  obstacle.radius = 0.3;
  obstacle.size = Vec3(0.4, 0.6, 0.2);
  obstacle.pose.position = Vec3(5.0, 0.0, 0.0);
  scene.obstacles.push_back(obstacle);
  return curtain::Simulator(scene).obstacleShape(0).triangles();
}

TEST(ShapeLight, CornersOfABoxHaveTheNormalsOfItsSides) {
  const std::vector<Vec3> normals = cornerNormals(trianglesOf(curtain::ShapeKind::kBox));
  ASSERT_EQ(normals.size(), 36u);
  for (const Vec3& normal : normals) {
    EXPECT_EQ(normal.cwiseAbs().maxCoeff(), 1.0) << normal.transpose();
    EXPECT_EQ(normal.norm(), 1.0) << normal.transpose();
  }
}

TEST(ShapeLight, NormalsOfASpherePointOutwardsFromItsCentre) {
  const curtain::ShapeTriangles sphere = trianglesOf(curtain::ShapeKind::kSphere);
  const std::vector<Vec3> normals = cornerNormals(sphere);
  ASSERT_EQ(normals.size(), 3 * sphere.triangles.size());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const int corner = sphere.triangles[i / 3][static_cast<int>(i % 3)];
    const Vec3 out = sphere.corners[static_cast<std::size_t>(corner)].normalized();
    // Facets of 48 around the axis are turned by 7.5 degrees; flat ones would be half of that off.
    EXPECT_GT(normals[i].dot(out), std::cos(0.5 * 7.5 * curtain::kPi / 180.0)) << i;
  }
}

TEST(ShapeLight, WhatFacesTheLightIsBrighterAndNothingIsBlackOrTooBright) {
  const Vec3 base(0.2, 0.9, 1.0);
  const auto up = litColour(base, Vec3::UnitZ()), down = litColour(base, -Vec3::UnitZ());
  const auto front = litColour(base, -Vec3::UnitY()), behind = litColour(base, Vec3::UnitY());
  EXPECT_GT(up.r, front.r);
  EXPECT_GT(front.r, behind.r);
  EXPECT_GT(behind.r, down.r);
  for (const auto& colour : {up, down, front, behind}) {
    EXPECT_GT(colour.r, 0.25F * 0.2F);
    EXPECT_LE(colour.b, 1.0F);
    EXPECT_EQ(colour.a, 1.0F);
  }
}

}  // namespace
}  // namespace curtain_ros
