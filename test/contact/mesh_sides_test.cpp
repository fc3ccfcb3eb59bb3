// SPDX-License-Identifier: BSD-3-Clause
//
// Closed meshes know their inside, open ones the side a node came from, whatever slivers they are made of.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "contact/all_triangles.h"
#include "obstacles/shapes.h"

namespace curtain {
namespace {

using namespace curtain_test;

TEST(MeshSides, WindingDoesNotMatterToAClosedMesh) {
  ShapeTriangles inward = BoxShape(Vec3(1.0, 1.0, 1.0)).triangles();
  for (Eigen::Vector3i& triangle : inward.triangles) {
    std::swap(triangle[0], triangle[1]);
  }
  const TriangleMeshShape shape(inward);
  SurfacePoint surface;
  ASSERT_TRUE(shape.query(Vec3(0.0, 0.1, 0.4), Vec3(0.0, 0.1, 0.4), 0.0, surface));
  EXPECT_NEAR(surface.distance, -0.1, kRounding);
  EXPECT_EQ(surface.normal, Vec3(Vec3::UnitZ()));
}

TEST(MeshSides, CavityIsOutside) {
  // A box within a box, its faces turned inward: the room inside is free.
  ShapeTriangles mesh = BoxShape(Vec3(2.0, 2.0, 2.0)).triangles();
  const ShapeTriangles room = BoxShape(Vec3(1.0, 1.0, 1.0)).triangles();
  for (const Eigen::Vector3i& t : room.triangles) {
    mesh.triangles.emplace_back(t[0] + 8, t[2] + 8, t[1] + 8);
  }
  mesh.corners.insert(mesh.corners.end(), room.corners.begin(), room.corners.end());
  const TriangleMeshShape shape(mesh);
  ASSERT_TRUE(shape.watertight());
  SurfacePoint surface;
  EXPECT_FALSE(shape.query(Vec3::Zero(), Vec3::Zero(), 0.4, surface));
  ASSERT_TRUE(shape.query(Vec3(0.4, 0.0, 0.0), Vec3(0.4, 0.0, 0.0), 0.2, surface));
  EXPECT_NEAR(surface.distance, 0.1, kRounding);
  EXPECT_EQ(surface.normal, Vec3(-Vec3::UnitX()));
}

TEST(MeshSides, ThinPlateGivesANodeBackToTheSideItCameFrom) {
  const TriangleMeshShape plate(BoxShape(Vec3(1.0, 1.0, 0.01)).triangles());
  SurfacePoint surface;
  ASSERT_TRUE(plate.query(Vec3(0.1, 0.2, 0.02), Vec3(0.1, 0.2, -0.004), 0.001, surface));
  EXPECT_NEAR(surface.distance, -0.009, kRounding);
  EXPECT_EQ(surface.normal, Vec3(Vec3::UnitZ()));
  ASSERT_TRUE(plate.query(Vec3(0.1, 0.2, 0.02), Vec3(0.1, 0.2, -0.5), 0.001, surface));
  EXPECT_NEAR(surface.distance, -0.505, kRounding);
  EXPECT_EQ(surface.normal, Vec3(Vec3::UnitZ()));
  ASSERT_TRUE(plate.query(Vec3(0.1, 0.2, -0.003), Vec3(0.1, 0.2, -0.004), 0.001, surface));
  EXPECT_NEAR(surface.distance, -0.001, kRounding);
  EXPECT_FALSE(plate.query(Vec3(0.51, 0.0, 0.02), Vec3(0.51, 0.0, -0.5), 0.001, surface));
}

TEST(MeshSides, OpenSheetRemembersTheSide) {
  const TriangleMeshShape shape(sheet(4, 0.25));
  ASSERT_FALSE(shape.watertight());
  SurfacePoint surface;
  const double z = 0.25;
  for (const double side : {1.0, -1.0}) {
    const Vec3 outward(0.0, 0.0, side);
    const Vec3 on(0.11, 0.07, z);
    // Near, on its own side.
    ASSERT_TRUE(shape.query(on + 0.02 * outward, on + 0.01 * outward, 0.05, surface));
    EXPECT_NEAR(surface.distance, 0.01, kRounding);
    EXPECT_EQ(surface.normal, outward);
    // Gone through: a little, and far beyond reach.
    for (const double depth : {1e-9, 0.01, 0.7}) {
      ASSERT_TRUE(shape.query(on + 0.02 * outward, on - depth * outward, 0.05, surface)) << depth;
      EXPECT_NEAR(surface.distance, -depth, kRounding);
      EXPECT_EQ(surface.normal, outward);
    }
    // Exactly on the sheet: only `previous` knows.
    ASSERT_TRUE(shape.query(on + 0.02 * outward, on, 0.05, surface));
    EXPECT_NEAR(surface.distance, 0.0, kRounding);
    EXPECT_EQ(surface.normal, outward);
    // From the sheet one leaves freely.
    ASSERT_TRUE(shape.query(on, on + 0.02 * outward, 0.05, surface));
    EXPECT_NEAR(surface.distance, 0.02, kRounding);
    EXPECT_EQ(surface.normal, outward);
    // Too far; and around the rim nothing is crossed.
    EXPECT_FALSE(shape.query(on + 0.2 * outward, on + 0.1 * outward, 0.05, surface));
    EXPECT_FALSE(shape.query(Vec3(0.6, 0.0, z + side), Vec3(0.6, 0.0, z - side), 0.05, surface));
    // Beside the rim the way out points away from it.
    ASSERT_TRUE(shape.query(Vec3(0.53, 0.0, z + 0.04 * side), Vec3(0.53, 0.0, z + 0.04 * side), 0.06, surface));
    EXPECT_NEAR(surface.distance, 0.05, kRounding);
    EXPECT_NEAR((surface.normal - Vec3(0.6, 0.0, 0.8 * side)).norm(), 0.0, 1e-12);  // 1e-14 / 0.05
  }
}

TEST(MeshSides, DoubledSheetIsAShell) {
  // Front and back of a square without thickness, cut along different diagonals: every edge has its two triangles,
  // but there is no inside.
  ShapeTriangles mesh;
  mesh.corners = {{-0.5, -0.5, 0.0}, {0.5, -0.5, 0.0}, {0.5, 0.5, 0.0}, {-0.5, 0.5, 0.0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 0, 3}, {3, 2, 1}};
  const TriangleMeshShape shape(mesh);
  SurfacePoint surface;
  for (const double side : {1.0, -1.0}) {
    ASSERT_TRUE(shape.query(Vec3(0.1, 0.2, 0.1 * side), Vec3(0.1, 0.2, -0.3 * side), 0.05, surface));
    EXPECT_NEAR(surface.distance, -0.3, kRounding);
    EXPECT_EQ(surface.normal, Vec3(0.0, 0.0, side));
    ASSERT_TRUE(shape.query(Vec3(0.1, 0.2, 0.1 * side), Vec3(0.1, 0.2, 0.01 * side), 0.05, surface));
    EXPECT_NEAR(surface.distance, 0.01, kRounding);
    EXPECT_EQ(surface.normal, Vec3(0.0, 0.0, side));
  }
}

TEST(MeshSides, SliversAndDegeneratesKeepAClosedMeshClosed) {
  // The box with a triangle of no area in one of its edges, as CAD programs write them.
  const BoxShape box(Vec3(1.0, 1.0, 1.0));
  ShapeTriangles mesh = box.triangles();
  mesh.corners.emplace_back(0.0, -0.5, 0.5);  // amid the edge 4-5
  for (Eigen::Vector3i& t : mesh.triangles) {
    if (t == Eigen::Vector3i(0, 5, 4)) {
      t = Eigen::Vector3i(0, 5, 8);
    }
  }
  mesh.triangles.emplace_back(0, 8, 4);
  mesh.triangles.emplace_back(4, 8, 5);
  const TriangleMeshShape shape(mesh);
  ASSERT_TRUE(shape.watertight());
  EXPECT_EQ(shape.triangles().triangles.size(), 13u);
  Random random(11);
  for (int k = 0; k < 20000; ++k) {
    // Around the edge with the sliver, on all sides.
    const Vec3 point = Vec3(random.between(-0.6, 0.6), -0.5, 0.5) + random.inBox(0.2);
    SurfacePoint surface;
    ASSERT_TRUE(shape.query(point, point, 1.0, surface));
    EXPECT_NEAR(surface.distance, box.nearest(point).distance, kRounding) << point.transpose();
  }
}

/// Random points around `place` have the sign of the winding number, and the distance of all triangles.
void expectSoundAround(const ShapeTriangles& mesh, const Vec3& place, double half) {
  const TriangleMeshShape shape(mesh);
  ASSERT_TRUE(shape.watertight());
  Random random(11);
  for (int k = 0; k < 5000; ++k) {
    const Vec3 point = place + random.inBox(half);
    SurfacePoint surface;
    ASSERT_TRUE(shape.query(point, point, 10.0, surface));
    EXPECT_EQ(surface.distance<0.0, windingNumber(mesh, point)> 0.5) << point.transpose();
    EXPECT_NEAR(std::abs(surface.distance), bruteDistance(shape.triangles(), point), 1e-12) << point.transpose();
  }
}

TEST(MeshSides, SpikeWithOneFinelySplitSideHasTheRightSignAtItsTip) {
  // Unweighted, the ten normals of the split side would outvote the others, and the far side of the tip would count
  // as inside.
  ShapeTriangles mesh;
  const int pieces = 10;
  mesh.corners = {{0.0, 0.0, 2.0}, {-0.2, 0.2, 0.0}, {-0.2, -0.2, 0.0}};
  for (int i = 0; i <= pieces; ++i) {
    mesh.corners.emplace_back(0.2, -0.2 + 0.4 * i / pieces, 0.0);
  }
  const int last = 3 + pieces;
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, last, 1}, {1, last, 2}};
  for (int i = 3; i < last; ++i) {
    mesh.triangles.emplace_back(0, i, i + 1);
    mesh.triangles.emplace_back(2, i + 1, i);
  }
  expectSoundAround(mesh, Vec3(0.0, 0.0, 2.0), 0.5);
}

TEST(MeshSides, SliverInASharpEdgeKeepsTheSignThere) {
  // A wedge whose edge along y has a triangle of no area in it: (0, 1, 6) with 6 amid 0 and 1.
  ShapeTriangles mesh;
  mesh.corners = {{0.0, -0.5, 0.0},  {0.0, 0.5, 0.0},  {1.0, -0.5, 0.1}, {1.0, 0.5, 0.1},
                  {1.0, -0.5, -0.1}, {1.0, 0.5, -0.1}, {0.0, 0.0, 0.0}};
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {0, 5, 4}, {0, 6, 5}, {6, 1, 5},
                    {2, 4, 5}, {2, 5, 3}, {0, 4, 2}, {1, 3, 5}, {0, 1, 6}};
  expectSoundAround(mesh, Vec3::Zero(), 0.4);
  // By symmetry every pseudonormal on the edge is -x, also where the sliver stands between the two faces.
  const MeshTopology topology = analyseMesh(mesh);
  int on_edge = 0;
  for (std::size_t t = 0; t < topology.mesh.triangles.size(); ++t) {
    for (int e = 0; e < 3; ++e) {
      if (cornerOf(topology.mesh, t, e).x() == 0.0 && cornerOf(topology.mesh, t, (e + 1) % 3).x() == 0.0) {
        ++on_edge;
        const Vec3& normal = topology.edge_normals[t][static_cast<std::size_t>(e)];
        EXPECT_NEAR((normal + Vec3::UnitX()).norm(), 0.0, kRounding) << t << " " << e;
      }
    }
  }
  EXPECT_EQ(on_edge, 3);
  EXPECT_NEAR((topology.corner_normals[6] + Vec3::UnitX()).norm(), 0.0, kRounding);
  // The same in the opposite order: of the triangles on either side of the edge, now the others are found first.
  std::reverse(mesh.triangles.begin(), mesh.triangles.end());
  expectSoundAround(mesh, Vec3::Zero(), 0.4);
}

}  // namespace
}  // namespace curtain
