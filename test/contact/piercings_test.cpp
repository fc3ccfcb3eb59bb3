// SPDX-License-Identifier: BSD-3-Clause
//
// The oracle for parts of the cloth inside obstacles, on cases whose answer can be counted by hand, and against dense
// sampling of the cloth.
#include "contact/oracle/piercings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "curtain_sim/simulator.h"
#include "obstacles/shapes.h"
#include "obstacles/triangle_mesh.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::Random;

constexpr double kTolerance = 1e-6;

/// Flat cloth in the plane z = height, rows along y and columns along x, a node every metre from the origin.
Field3 flatCloth(const Grid& grid, double height) {
  Field3 position;
  position.assign(grid.size(), 1e9);  // padding: far from everything
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) position.set(grid.index(i, j), Vec3(j, i, height));
  }
  return position;
}

Transform at(const Vec3& place) {
  Transform transform;
  transform.translation = place;
  return transform;
}

void expectCount(const Piercings& count, int nodes, int edges, int faces, const std::string& what) {
  EXPECT_EQ(count.nodes, nodes) << what;
  EXPECT_EQ(count.edges, edges) << what;
  EXPECT_EQ(count.faces, faces) << what;
}

TEST(Piercings, OfAPeaAreCountedByWhereItSits) {
  const SphereShape pea(0.05);
  const TriangleMeshShape mesh(pea.triangles());
  ASSERT_TRUE(mesh.watertight());
  const Grid grid(4, 4, false);
  const Field3 cloth = flatCloth(grid, 0.0);
  const auto count = [&](const Vec3& place) { return countPiercings(pea, at(place), grid, cloth, kTolerance); };
  expectCount(count(Vec3(1.0, 1.0, 0.0)), 1, 6, 6, "around a node");
  expectCount(count(Vec3(1.5, 1.0, 0.0)), 0, 1, 2, "around a link");
  expectCount(count(Vec3(1.5, 1.5, 0.0)), 0, 1, 2, "around a diagonal");
  expectCount(count(Vec3(1.2, 1.2, 0.0)), 0, 0, 1, "in a face");
  expectCount(count(Vec3(0.0, 0.0, 0.0)), 1, 2, 1, "around the corner that two links meet at");
  expectCount(count(Vec3(3.0, 0.0, 0.0)), 1, 3, 2, "around the corner that a diagonal meets, too");
  expectCount(count(Vec3(1.2, 1.2, 0.051)), 0, 0, 0, "above");
  expectCount(count(Vec3(1.2, 1.2, 0.05 - 0.5e-6)), 0, 0, 0, "touching by less than the tolerance");
  expectCount(count(Vec3(1.2, 1.2, 0.05 - 2e-6)), 0, 0, 1, "touching by more");
  const auto count_mesh = [&](const Vec3& place) { return countPiercings(mesh, at(place), grid, cloth, kTolerance); };
  expectCount(count_mesh(Vec3(1.0, 1.0, 0.01)), 1, 6, 6, "mesh around a node");
  expectCount(count_mesh(Vec3(1.5, 1.0, 0.01)), 0, 1, 2, "mesh around a link");
  expectCount(count_mesh(Vec3(1.2, 1.2, 0.01)), 0, 0, 1, "mesh in a face");
  expectCount(count_mesh(Vec3(1.2, 1.2, 0.06)), 0, 0, 0, "mesh above");
}

TEST(Piercings, AreSeenWhereTheRingCloses) {
  const SphereShape pea(0.05);
  for (const bool closed : {false, true}) {
    const Grid grid(2, 3, closed);
    Field3 cloth;
    cloth.assign(grid.size(), 1e9);
    const Vec3 ring[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 3; ++j) cloth.set(grid.index(i, j), ring[j] - i * Vec3::UnitZ());
    }
    const Piercings count = countPiercings(pea, at(Vec3(0.0, 0.5, 0.0)), grid, cloth, kTolerance);
    expectCount(count, 0, closed ? 1 : 0, closed ? 1 : 0, "the link from the last column to the first");
  }
}

TEST(Piercings, OfACornerThatEdgesCutAreSeen) {
  // A box whose corner reaches between the nodes: cloth laid over its ridge, nodes outside.
  const BoxShape box(Vec3(10.0, 10.0, 1.0));
  const TriangleMeshShape mesh(box.triangles());
  ASSERT_TRUE(mesh.watertight());
  const Grid grid(2, 2, false);
  Field3 cloth;
  cloth.assign(grid.size(), 1e9);
  for (int i = 0; i < 2; ++i) {
    cloth.set(grid.index(i, 0), Vec3(4.5, 0.3 * i, 0.52));
    cloth.set(grid.index(i, 1), Vec3(5.02, 0.3 * i, 0.0));
  }
  for (const ContactShape* shape : {static_cast<const ContactShape*>(&box), static_cast<const ContactShape*>(&mesh)}) {
    expectCount(countPiercings(*shape, Transform(), grid, cloth, kTolerance), 0, 3, 2, "over the ridge");
  }
}

TEST(Piercings, OfAShellAreOnlyWhatGoesThrough) {
  ShapeTriangles square;
  square.corners = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  const TriangleMeshShape shell(square);
  ASSERT_FALSE(shell.watertight());
  const Grid grid(2, 2, false);
  Field3 cloth;
  cloth.assign(grid.size(), 1e9);
  const auto lay = [&](const std::function<Vec3(double, double)>& f) {
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) cloth.set(grid.index(i, j), f(j, i));
    }
    return countPiercings(shell, Transform(), grid, cloth, kTolerance);
  };
  expectCount(lay([](double u, double v) { return Vec3(0.2 * u, 0.0, 0.5 - v); }), 0, 3, 2, "through the middle");
  expectCount(lay([](double u, double v) { return Vec3(0.2 * u, 0.1 * u, 0.5 - v); }), 0, 3, 2, "across its diagonal");
  expectCount(lay([](double u, double v) { return Vec3(u, v, 0.5 * kTolerance * (u - v)); }), 0, 0, 0, "laid on it");
  expectCount(lay([](double u, double v) { return Vec3(u, v, 0.1); }), 0, 0, 0, "above");
  // Of what crosses z = 0 only the link at u = 0 does so at x < 1. The rim ends in its face, a quarter of the way on.
  const Piercings rim = lay([](double u, double v) { return Vec3(0.9 + 0.4 * u, 0.0, 0.5 - v); });
  expectCount(rim, 0, 1, 1, "half through the rim");
}

TEST(Piercings, OfAShellsRimThroughAFaceAreSeen) {
  ShapeTriangles blade;  // a triangle whose tip stabs the cloth from below between its nodes
  blade.corners = {{0.2, 0.2, 0.1}, {0.15, 0.2, -1.0}, {0.25, 0.2, -1.0}};
  blade.triangles = {{0, 1, 2}};
  const TriangleMeshShape shell(blade);
  const Grid grid(2, 2, false);
  expectCount(countPiercings(shell, Transform(), grid, flatCloth(grid, 0.0), kTolerance), 0, 0, 1, "stabbed");
  expectCount(countPiercings(shell, Transform(), grid, flatCloth(grid, 0.2), kTolerance), 0, 0, 0, "not reached");
  expectCount(countPiercings(shell, Transform(), grid, flatCloth(grid, 0.1 - 1e-7), kTolerance), 0, 0, 0, "pricked");
}

TEST(Piercings, OfThePlaneAreWhatLiesBelow) {
  const PlaneShape plane;
  const Grid grid(3, 3, false);
  Field3 cloth = flatCloth(grid, 0.0);
  expectCount(countPiercings(plane, Transform(), grid, cloth, kTolerance), 0, 0, 0, "laid on it");
  cloth.set(grid.index(1, 1), Vec3(1.0, 1.0, -0.1));
  expectCount(countPiercings(plane, Transform(), grid, cloth, kTolerance), 1, 6, 6, "a node below");
  Pose upside_down;
  upside_down.orientation = Eigen::AngleAxisd(curtain_test::kPi, Vec3::UnitX());
  upside_down.position = Vec3(0.0, 0.0, -0.05);
  expectCount(countPiercings(plane, Transform(upside_down), grid, cloth, kTolerance), 8, 16, 8, "all but one above");
}

/// Whether a sample of the element is deeper than the limit.
bool sampledDeep(const ContactShape& shape, const Vec3& a, const Vec3& b, const Vec3& c, double limit) {
  constexpr int kSteps = 40;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      const Vec3 point = a + (b - a) * i / kSteps + (c - a) * j / kSteps;
      SurfacePoint surface;
      if (shape.query(point, point, 1.0, surface) && surface.distance < -limit) return true;
    }
  }
  return false;
}

// One face of cloth at random places: nodes and edges with a deep sample must count; with a margin of the sampling, no
// others may.
TEST(Piercings, AgreeWithSamplesOfTheCloth) {
  const SphereShape sphere(0.5);
  const BoxShape box(Vec3(0.6, 1.0, 0.4));
  const CylinderShape cylinder(0.3, 0.8);
  const CapsuleShape capsule(0.3, 0.6);
  const TriangleMeshShape mesh(cylinder.triangles());
  const std::map<std::string, const ContactShape*> shapes = {
      {"sphere", &sphere}, {"box", &box}, {"cylinder", &cylinder}, {"capsule", &capsule}, {"mesh", &mesh}};
  Random random(1);
  const Grid grid(2, 2, false);
  for (const auto& [name, shape] : shapes) {
    int through = 0;
    for (int n = 0; n < 300; ++n) {
      Field3 cloth;
      cloth.assign(grid.size(), 1e9);
      const Vec3 centre = random.inBox(0.6);
      Vec3 node[2][2];
      for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
          node[i][j] = centre + random.inBox(0.5);
          cloth.set(grid.index(i, j), node[i][j]);
        }
      }
      Pose pose;
      pose.position = random.inBox(2.0);
      pose.orientation = Eigen::AngleAxisd(random.between(0.0, 3.0), random.direction());
      Field3 moved = cloth;
      for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) moved.set(grid.index(i, j), Transform(pose).toWorld(node[i][j]));
      }
      const Piercings count = countPiercings(*shape, Transform(pose), grid, moved, kTolerance);
      std::vector<Vec3> points;
      for (std::size_t node_of_grid = 0; node_of_grid < grid.size(); ++node_of_grid)
        points.push_back(moved.at(node_of_grid));
      const Piercings by_points =
          countPiercings(*shape, Transform(pose), points, makeCoarseMesh(grid).triangles, kTolerance);
      expectCount(by_points, count.nodes, count.edges, count.faces, name + ", given as a mesh");
      const auto deep = [&, &s = *shape](const Vec3& a, const Vec3& b, const Vec3& c, double limit) {
        return static_cast<int>(sampledDeep(s, a, b, c, limit));
      };
      const auto all = [&](double limit) {
        Piercings sampled;
        for (const auto& row : node) {
          for (const Vec3& p : row) sampled.nodes += deep(p, p, p, limit);
        }
        const std::pair<Vec3, Vec3> edges[] = {{node[0][0], node[0][1]},
                                               {node[0][0], node[1][0]},
                                               {node[0][1], node[1][0]},
                                               {node[0][1], node[1][1]},
                                               {node[1][0], node[1][1]}};
        for (const auto& [a, b] : edges) sampled.edges += deep(a, b, a, limit);
        sampled.faces =
            deep(node[0][0], node[1][0], node[0][1], limit) + deep(node[1][1], node[1][0], node[0][1], limit);
        return sampled;
      };
      const Piercings sampled = all(kTolerance);
      EXPECT_EQ(count.nodes, sampled.nodes) << name;
      EXPECT_GE(count.edges, sampled.edges) << name;
      EXPECT_GE(count.faces, sampled.faces) << name;
      // Samples lie at most 1.7 m / 40 apart: a part that counts has one that is no further out than half of that.
      through += count.edges > 0 && count.nodes == 0;
      if (count.edges > sampled.edges || count.faces > sampled.faces) {
        const Piercings around = all(-0.022);
        EXPECT_LE(count.edges, around.edges) << name;
        EXPECT_LE(count.faces, around.faces) << name;
      }
    }
    EXPECT_GT(through, 10) << name;
  }
}

TEST(Piercings, OfASimulationAreOfWhereItsClothIs) {
  Scene scene = curtain_test::flatScene(11, 11);
  ObstacleParams obstacle;
  obstacle.name = "pea";
  obstacle.shape = ShapeKind::kSphere;
  obstacle.radius = 0.02;
  obstacle.pose.position = Vec3(0.55, 5.0, 0.55);
  scene.obstacles.push_back(obstacle);
  Simulator simulator(scene);
  EXPECT_EQ(simulator.piercings(0).edges, 0);
  Pose pose;
  pose.position = Vec3(0.55, 0.0, 0.55);  // in the middle of a square
  simulator.setObstaclePose(0, pose, true);
  expectCount(simulator.piercings(0), 0, 1, 2, "put there");
  simulator.setObstaclePresent(0, false);
  expectCount(simulator.piercings(0), 0, 0, 0, "absent");
}

}  // namespace
}  // namespace curtain
