// SPDX-License-Identifier: BSD-3-Clause
//
// Obstacles in a source's cone keep its wind from the nodes behind them, if the source says so.
#include "parts/wind/wind_shadow.h"

#include <gtest/gtest.h>

#include "curtain_sim/simulator.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;

WindParams fan(bool shadow) {
  WindParams wind;
  wind.id = "fan";
  wind.position = Vec3(0.5, -2.0, 0.5);
  wind.direction = Vec3::UnitY();
  wind.radius = 1.0;
  wind.half_angle = 0.2;
  wind.pressure = 5.0;
  wind.shadow = shadow;
  return wind;
}

ObstacleParams ball(const Vec3& position, double radius) {
  ObstacleParams obstacle;
  obstacle.name = "ball";
  obstacle.radius = radius;
  obstacle.pose.position = position;
  return obstacle;
}

// The cloth, its source and what it leaves of it; 21 x 21 nodes in a square metre at y = 0.
struct Shade {
  explicit Shade(const ObstacleParams& obstacle, const WindParams& wind = fan(true))
      : scene(withObstacle(obstacle)),
        pattern(makePattern(scene)),
        position(makeInitialState(scene, pattern).position),
        obstacles(scene, shapesBy(resolveMeshUrl)),
        source(wind, pattern, scene.cloth, 1) {
    WindShadow(pattern).cast(obstacles, pattern.grid, position, source);
  }
  static Scene withObstacle(const ObstacleParams& obstacle) {
    Scene scene = flatScene(21, 21);
    scene.obstacles = {obstacle};
    return scene;
  }
  double at(int row, int column) { return source.shade()[pattern.grid.index(row, column)]; }

  Scene scene;
  ClothPattern pattern;
  Field3 position;
  ObstacleSet obstacles;
  WindSource source;
};

// The ball half way, seen along the lines of the cone: node C at x from the axis is reached along the line from B at
// x r / (r + 2 tan(0.2)), which passes the ball at their mean. Its shadow on the cloth ends where that is the radius.
TEST(WindShadow, CoreIsBlockedEdgeIsSoftAndTheRestIsFree) {
  constexpr double kRadius = 0.2;
  Shade shade(ball({0.5, -1.0, 0.5}, kRadius));
  EXPECT_TRUE(shade.source.shaded());
  const double apex = 1.0 / std::tan(0.2), shrink = apex / (apex + 2.0);
  const double edge = kRadius / (0.5 * (1.0 + shrink));
  const double soft =
      0.5 * 0.1 * 2.0 / (0.5 * (1.0 + shrink)) * 1.1;  // half of the bundle's width, seen from the cloth
  int partly = 0;
  for (int i = 0; i < 21; ++i) {
    for (int j = 0; j < 21; ++j) {
      const double from_axis = 0.05 * std::hypot(i - 10, j - 10), left = shade.at(i, j);
      EXPECT_TRUE(from_axis >= edge - soft || left == 0.0) << i << ", " << j << ": " << left;
      EXPECT_TRUE(from_axis <= edge + soft || left == 1.0) << i << ", " << j << ": " << left;
      partly += left > 0.0 && left < 1.0 ? 1 : 0;
    }
  }
  EXPECT_GT(partly, 8);
}

TEST(WindShadow, IsLeftAloneWithoutTheFlagOrAnObstacleInTheCone) {
  EXPECT_TRUE(Shade(ball({0.5, -1.0, 0.5}, 0.2), fan(false)).source.shade().empty());
  for (const Vec3& place : {Vec3(0.5, -4.0, 0.5), Vec3(5.0, -1.0, 0.5)}) {
    Shade outside(ball(place, 0.2));
    EXPECT_FALSE(outside.source.shaded());
    EXPECT_EQ(outside.at(10, 10), 1.0);
  }
  Shade behind(ball({0.5, 1.0, 0.5}, 0.2));
  EXPECT_EQ(behind.at(10, 10), 1.0) << "in the cone, behind the cloth";
}

TEST(WindShadow, ThinWallsAndPlanesBlockToo) {
  ObstacleParams wall = ball({0.5, -1.0, 0.5}, 0.0);
  wall.shape = ShapeKind::kBox;
  wall.size = Vec3(0.6, 0.001, 3.0);
  Shade behind_wall(wall);
  EXPECT_EQ(behind_wall.at(3, 10), 0.0);
  EXPECT_EQ(behind_wall.at(3, 0), 1.0);
  ObstacleParams plane = ball({0.0, -1.0, 0.0}, 0.0);
  plane.shape = ShapeKind::kPlane;
  plane.pose.orientation =
      Eigen::Quaterniond(Eigen::AngleAxisd(-0.5 * curtain_test::kPi, Vec3::UnitX()));  // towards +y
  Shade behind_plane(plane);
  EXPECT_EQ(behind_plane.at(10, 10), 0.0);
  plane.pose.position.y() = -3.0;  // behind the fan
  EXPECT_EQ(Shade(plane).at(10, 10), 1.0);
}

TEST(WindShadow, ClothBehindAnObstacleHangsStill) {
  const auto billow = [](bool shadow) {
    Scene scene = flatScene(12, 10);
    scene.wind = {fan(shadow)};
    scene.air.inside = scene.air.border = scene.air.corner = 0.5;
    scene.obstacles = {ball({0.5, -1.2, 0.5}, 0.75)};
    Simulator simulator(scene);
    for (int frame = 0; frame < 60; ++frame) simulator.step();
    return simulator.position({11, 5}).y();
  };
  EXPECT_GT(billow(false), 0.05);
  EXPECT_LT(std::abs(billow(true)), 1e-12);
}

TEST(WindShadow, AnObstacleThatLeavesWakesTheCloth) {
  Scene scene = flatScene(12, 10);
  scene.wind = {fan(true)};
  scene.obstacles = {ball({0.5, -1.2, 0.5}, 0.75)};
  Simulator simulator(scene);
  for (int frame = 0; frame < 120; ++frame) simulator.step();
  ASSERT_TRUE(simulator.statistics().asleep);
  Pose away;
  away.position = Vec3(9.0, -1.2, 0.5);
  simulator.setObstaclePose(0, away, true);
  for (int frame = 0; frame < 30; ++frame) simulator.step();
  EXPECT_FALSE(simulator.statistics().asleep);
  EXPECT_GT(simulator.position({11, 5}).y(), 0.02);
}

}  // namespace
}  // namespace curtain
