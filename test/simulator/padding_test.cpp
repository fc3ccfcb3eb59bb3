// SPDX-License-Identifier: BSD-3-Clause
//
// The cloth keeps an obstacle's padding from its surface, beyond the thickness: links and faces, too, around corners,
// at rest and while the obstacle moves into it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>

#include "curtain_sim/simulator.h"
#include "figures.h"
#include "testing.h"

namespace curtain {
namespace {

constexpr double kPadding = 0.02;

// Of the points, from a closed obstacle that stands at its pose [m].
double nearest(const Simulator& simulator, const std::vector<Vec3>& points) {
  const Pose& pose = simulator.obstaclePose(0);
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& point : points) {
    const Vec3 local = pose.orientation.conjugate() * (point - pose.position);
    SurfacePoint surface;
    if (simulator.obstacleShape(0).query(local, local, 2.0 * kPadding, surface))
      least = std::min(least, surface.distance);
  }
  return least;
}

// The nodes, and the middles of the links between them.
std::vector<Vec3> samplesOf(const Simulator& simulator) {
  std::vector<Vec3> points;
  for (int i = 0; i < simulator.rows(); ++i) {
    for (int j = 0; j < simulator.columns(); ++j) {
      const Vec3 at = simulator.position({i, j});
      points.push_back(at);
      if (i > 0) points.push_back(0.5 * (at + simulator.position({i - 1, j})));
      if (j > 0) points.push_back(0.5 * (at + simulator.position({i, j - 1})));
    }
  }
  return points;
}

ObstacleParams obstacleOf(ShapeKind shape, double padding) {
  ObstacleParams obstacle;
  obstacle.name = "obstacle";
  obstacle.shape = shape;
  obstacle.radius = 0.15;
  obstacle.length = 0.4;
  obstacle.size = Vec3(0.4, 0.3, 0.5);
  obstacle.mesh = std::string(CURTAIN_SOURCE_DIR) + "/test/meshes/icosphere.stl";
  obstacle.scale = Vec3(0.2, 0.2, 0.2);
  obstacle.padding = padding;
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(1.2, Vec3(1.0, 1.0, 0.3).normalized()));
  obstacle.motion = {{0.0, {Vec3(0.3, -0.5, 1.0), Eigen::Quaterniond::Identity()}},
                     {1.0, {Vec3(0.4, 0.25, 1.1), turned}},
                     {2.0, {Vec3(0.4, 0.25, 1.1), turned}}};
  return obstacle;
}

Simulator pushedCurtain(ShapeKind shape, double padding) {
  Scene scene;
  scene.cloth.rows = 30;
  scene.cloth.columns = 24;
  scene.cloth.width = 0.8;
  scene.hang.to = Vec3(0.7, 0.0, 2.2);
  scene.air.inside = scene.air.border = scene.air.corner = 0.1;
  scene.obstacles.push_back(obstacleOf(shape, padding));
  return Simulator(scene);
}

class Padding : public ::testing::TestWithParam<ShapeKind> {};

TEST_P(Padding, IsKept) {
  const bool convex = GetParam() != ShapeKind::kMesh;
  Simulator simulator = pushedCurtain(GetParam(), kPadding);
  double least = std::numeric_limits<double>::infinity(), at_rest = least;
  int nearer = 0;
  while (simulator.time() < 2.0) {
    simulator.step();
    at_rest = nearest(simulator, samplesOf(simulator));
    least = std::min(least, at_rest);
    const Piercings count = convex ? simulator.piercings(0, -kPadding) : Piercings();
    nearer += count.nodes + count.edges + count.faces;
  }
  const Statistics& s = simulator.statistics();
  std::printf("kept %.4f m, at rest %.4f m, contacts %d, sweeps %d a frame, stops %d\n", least, at_rest, s.contacts,
              static_cast<int>(s.sweeps / s.frames), static_cast<int>(s.stops));
  curtain_test::keepFigure("padding of 20 mm, kept [mm]", 1e3 * least);
  EXPECT_GT(s.contacts, 0);
  EXPECT_GE(least, kPadding);
  EXPECT_LT(at_rest, kPadding + 1.5 * simulator.scene().contact.thickness) << "and it lies there";
  EXPECT_EQ(nearer, 0);
  EXPECT_EQ(s.stops, 0);
  EXPECT_LE(std::max(s.warp_stretch_max, s.weft_stretch_max), simulator.scene().solver.stretch_tolerance);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Padding,
                         ::testing::Values(ShapeKind::kSphere, ShapeKind::kBox, ShapeKind::kCylinder,
                                           ShapeKind::kCapsule, ShapeKind::kMesh));

// A sphere with padding is a larger sphere: the same contacts, so the same motion but for rounding, as long as nothing
// is deeper than the surface of the smaller one.
TEST(Padding, OfASphereIsALargerSphere) {
  const auto run = [](double radius, double padding) {
    Scene scene;
    scene.cloth.rows = scene.cloth.columns = 15;
    scene.cloth.width = scene.cloth.height = 0.6;
    scene.hang.from = Vec3(-0.3, 0.3, 0.25);
    scene.hang.to = Vec3(0.3, 0.3, 0.25);
    scene.hang.tilt = 0.5 * curtain_test::kPi;
    scene.pins.kind = PinKind::kNone;
    ObstacleParams ball = curtain_test::ballAt({0.01, 0.02, 0.0}, radius);
    ball.padding = padding;
    scene.obstacles.push_back(ball);
    Simulator simulator(scene);
    // The first two frames that touch: an impact of limp cloth doubles what rounding leaves in every sweep.
    for (int frame = 0; frame < 7; ++frame) simulator.step();
    EXPECT_GT(simulator.statistics().contacts, 10);
    return simulator.position({7, 7});
  };
  EXPECT_LT((run(0.2, 0.0) - run(0.17, 0.03)).norm(), 1e-9);
}

}  // namespace
}  // namespace curtain
