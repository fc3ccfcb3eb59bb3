// SPDX-License-Identifier: BSD-3-Clause
//
// How much of an obstacle the cloth hides: flat cloth beside and before obstacles, whose shares are known.
//
// The share is that of 128 x 128 points of the rectangle around the silhouette. A straight edge across it is known to
// half a point's distance, 1/256 of the rectangle; a round silhouette has pi/4 of its points, which its own edge, of
// facets, may take or leave: 2 % allowed.
#include <gtest/gtest.h>

#include <cmath>

#include "curtain_sim/simulator.h"
#include "testing.h"

namespace curtain {
namespace {

// The cloth hangs in y = 0, from x = 0 to 1 and z = 0 to 1.
double shareOf(const Vec3& position, ShapeKind shape, const Vec3& from) {
  Scene scene = curtain_test::flatScene(6, 6);
  ObstacleParams thing;
  thing.name = "thing";
  thing.shape = shape;
  thing.radius = 0.2;
  thing.length = 0.4;
  thing.size = Vec3(0.4, 0.2, 0.4);
  thing.mesh = std::string(CURTAIN_SOURCE_DIR) + "/test/meshes/icosphere.stl";
  if (shape == ShapeKind::kMesh) thing.scale = Vec3::Constant(0.2);
  thing.pose.position = position;
  scene.obstacles = {thing};
  return Simulator(scene).covered(0, from);
}

TEST(Coverage, IsTheShareOfTheSilhouette) {
  const Vec3 front = -Vec3::UnitY();
  for (const ShapeKind shape : {ShapeKind::kSphere, ShapeKind::kBox, ShapeKind::kMesh}) {
    SCOPED_TRACE(static_cast<int>(shape));
    EXPECT_EQ(shareOf({0.5, 0.5, 0.5}, shape, front), 1.0) << "behind the cloth";
    EXPECT_EQ(shareOf({0.5, -0.5, 0.5}, shape, front), 0.0) << "before it";
    EXPECT_EQ(shareOf({0.5, 0.5, 0.5}, shape, -front), 0.0) << "seen from behind";
    EXPECT_EQ(shareOf({3.0, 0.5, 0.5}, shape, front), 0.0) << "beside it";
    EXPECT_NEAR(shareOf({1.0, 0.5, 0.5}, shape, front), 0.5, 0.02) << "half beside it";
    EXPECT_NEAR(shareOf({1.0, 0.5, 0.5}, shape, 5.0 * front), 0.5, 0.02);
  }
  EXPECT_NEAR(shareOf({0.9, 0.5, 0.5}, ShapeKind::kBox, front), 0.75, 1.0 / 128.0);
}

// At 45 degrees what is hidden is shifted by the distance from the cloth.
TEST(Coverage, DependsOnTheDirection) {
  const Vec3 aslant = Vec3(1.0, -1.0, 0.0);
  EXPECT_EQ(shareOf({0.2, 0.5, 0.5}, ShapeKind::kSphere, aslant), 1.0);
  EXPECT_EQ(shareOf({0.2, 0.5, 0.5}, ShapeKind::kSphere, Vec3(-1.0, -1.0, 0.0)), 0.0);
  EXPECT_NEAR(shareOf({0.5, 0.5, 0.5}, ShapeKind::kSphere, aslant), 0.5, 0.02);
}

// Of the points of a square behind the cloth, a metre wide and high, those in its shadow are hidden; from the other
// side none is, nor from along the cloth.
TEST(Coverage, HidesThePointsInItsShadow) {
  const Simulator simulator(curtain_test::flatScene(5, 6));
  const Vec3 from(0.4, -1.0, 0.3);
  curtain_test::Random random(7);
  int hidden = 0;
  for (int k = 0; k < 400; ++k) {
    const Vec3 point(random.between(-1.0, 2.0), random.between(0.05, 0.5), random.between(-1.0, 2.0));
    const Vec3 on_cloth = point + point.y() * from;
    const bool in_shadow = on_cloth.x() > 0.0 && on_cloth.x() < 1.0 && on_cloth.z() > 0.0 && on_cloth.z() < 1.0;
    EXPECT_EQ(simulator.hides(point, from), in_shadow) << point.transpose();
    EXPECT_FALSE(simulator.hides(point, -from));
    EXPECT_FALSE(simulator.hides(point, Vec3::UnitX()));
    hidden += in_shadow ? 1 : 0;
  }
  EXPECT_GT(hidden, 20);
}

TEST(Coverage, OfWhatHasNoSilhouetteIsNoNumber) {
  EXPECT_TRUE(std::isnan(shareOf({0.0, 0.0, 0.0}, ShapeKind::kPlane, Vec3::UnitZ())));
  Scene scene = curtain_test::flatScene(4, 4);
  scene.obstacles = {curtain_test::ballAt({0.5, 0.5, 0.5}, 0.2)};
  Simulator simulator(scene);
  DragParams drag;
  drag.id = "drag";
  drag.node = NodeIndex{3, 3};
  drag.force = Vec3(1e100, 0.0, 0.0);
  scene.drag = {drag};
  Simulator torn(scene);
  for (int frame = 0; frame < 5; ++frame) torn.step();
  EXPECT_LE(torn.covered(0, -Vec3::UnitY()), 1.0) << "nodes that are no numbers hide nothing";
  simulator.setObstaclePresent(0, false);
  EXPECT_TRUE(std::isnan(simulator.covered(0, -Vec3::UnitY())));
}

}  // namespace
}  // namespace curtain
