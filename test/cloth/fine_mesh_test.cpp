// SPDX-License-Identifier: BSD-3-Clause
//
// The fine mesh is one sheet (a disc, or an annulus where the cloth is closed) of both layers of nodes, wound as the
// node normals point.
#include "curtain_sim/fine_mesh.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <stdexcept>

#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::kEps;
using curtain_test::ringScene;

struct Shape {
  int rows, columns, folds;
  bool closed;
};

const Shape kShapes[] = {{2, 2, 1, false}, {2, 2, 6, false}, {5, 4, 1, false}, {4, 7, 6, false}, {3, 3, 64, false},
                         {2, 3, 1, true},  {2, 3, 2, true},  {5, 4, 1, true},  {4, 7, 6, true}};

ClothParams clothOf(const Shape& shape) {
  ClothParams cloth;
  cloth.rows = shape.rows;
  cloth.columns = shape.columns;
  cloth.folds = shape.folds;
  cloth.closed = shape.closed;
  return cloth;
}

TEST(FineMesh, IsADiscOrAnAnnulusWoundOneWay) {
  for (const Shape& shape : kShapes) {
    SCOPED_TRACE(testing::Message() << shape.rows << " x " << shape.columns << " folds " << shape.folds << " closed "
                                    << shape.closed);
    const FineMeshTopology mesh = makeFineMeshTopology(clothOf(shape));
    const int links = shape.closed ? shape.columns : shape.columns - 1;
    EXPECT_EQ(mesh.rows, shape.rows);
    EXPECT_EQ(mesh.folds, shape.folds);
    EXPECT_EQ(mesh.columns, links * shape.folds + (shape.closed ? 0 : 1));
    const auto node_count = static_cast<std::size_t>(mesh.rows) * static_cast<std::size_t>(mesh.columns);
    std::set<std::uint32_t> used;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
    for (const auto& triangle : mesh.triangles) {
      ASSERT_NE(triangle[0], triangle[1]);
      ASSERT_NE(triangle[1], triangle[2]);
      ASSERT_NE(triangle[2], triangle[0]);
      for (std::size_t corner = 0; corner < 3; ++corner) {
        ASSERT_LT(triangle[corner], node_count);
        used.insert(triangle[corner]);
        ++directed[{triangle[corner], triangle[(corner + 1) % 3]}];
      }
    }
    EXPECT_EQ(used.size(), node_count) << "every fine node is a corner";
    std::size_t edges = 0, border = 0;
    for (const auto& [edge, times] : directed) {
      EXPECT_EQ(times, 1) << "each edge once each way: same winding on both sides, no more than two faces";
      const bool both = directed.count({edge.second, edge.first}) > 0;
      if (!both) ++border;
      if (!both || edge.first < edge.second) ++edges;
    }
    const auto euler =
        static_cast<long>(node_count) - static_cast<long>(edges) + static_cast<long>(mesh.triangles.size());
    EXPECT_EQ(euler, shape.closed ? 0 : 1);
    const int around = shape.closed ? 2 * mesh.columns : 2 * (mesh.columns - 1) + 2 * (mesh.rows - 1);
    EXPECT_EQ(border, static_cast<std::size_t>(around)) << "border edges";
  }
}

// Both layers without obstacles.
FineMesh build(const Scene& scene, const ClothPattern& pattern, const Field3& position) {
  const Grid& grid = pattern.grid;
  std::vector<double> weft_rest;
  std::vector<Vec3> nodes;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) nodes.push_back(position.at(grid.index(i, j)));
    for (int link = 0; link < grid.linkCount(); ++link) {
      weft_rest.push_back(pattern.weft_rest[grid.index(i, (link + 1) % grid.columns)]);
    }
  }
  FineMesh mesh;
  FineMeshBuilder(scene.cloth, weft_rest).build(nodes, mesh);
  return mesh;
}

TEST(FineMesh, WindingAndNormalsAgreeWithTheNodeNormals) {
  for (const bool closed : {false, true}) {
    for (const int folds : {1, 6}) {
      Scene scene = closed ? ringScene(5, 12) : flatScene(5, 12);
      scene.cloth.folds = folds;
      const ClothPattern pattern = makePattern(scene);
      const Field3 position = makeInitialState(scene, pattern).position;
      Field3 vectors;
      vectors.assign(pattern.grid.size(), 0.0);
      nodeAreaVectors(pattern.grid, position, vectors);
      const FineMeshTopology topology = makeFineMeshTopology(scene.cloth);
      const FineMesh mesh = build(scene, pattern, position);
      std::vector<Vec3> normals;
      fineMeshNormals(topology, mesh, normals);
      ASSERT_EQ(normals.size(), mesh.positions.size());
      for (int i = 0; i < 5; ++i) {
        for (int j = 0; j < 12; ++j) {
          const Vec3& fine = normals[static_cast<std::size_t>(i * topology.columns + j * folds)];
          const Vec3 node = vectors.at(pattern.grid.index(i, j)).normalized();
          EXPECT_NEAR(fine.norm(), 1.0, 8 * kEps);
          // Flat: the same. Ring: faces at a node turn by up to 2 pi/12 from its normal, plus folds almost taut
          // (chord 0.9886 of the link: half turn of the arc 0.26).
          EXPECT_GE(fine.dot(node), closed ? std::cos(0.53 + 0.27) : 1.0 - 64 * kEps) << i << ", " << j;
        }
      }
    }
  }
}

TEST(FineMeshBuilder, RefusesLengthsAndNodesThatAreNotOfItsGrid) {
  for (const bool closed : {false, true}) {
    const ClothParams cloth = clothOf({3, 4, 2, closed});
    const std::size_t links = closed ? 12 : 9;
    const std::vector<double> rest(links, 0.1);
    FineMeshBuilder builder(cloth, rest);
    FineMesh mesh;
    builder.build(std::vector<Vec3>(12, Vec3::Zero()), mesh);
    EXPECT_EQ(mesh.positions.size(), closed ? 24u : 21u);
    EXPECT_THROW(builder.build(std::vector<Vec3>(11, Vec3::Zero()), mesh), std::invalid_argument);
    EXPECT_THROW(FineMeshBuilder(cloth, std::vector<double>(links + 1, 0.1)), std::invalid_argument);
    for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
      std::vector<double> with_bad = rest;
      with_bad[4] = bad;
      EXPECT_THROW(FineMeshBuilder(cloth, with_bad), std::invalid_argument) << bad;
    }
  }
}

TEST(FineMesh, NormalsOfAMeshCrushedToAPointAreUnitVectors) {
  const FineMeshTopology topology = makeFineMeshTopology(clothOf({3, 3, 2, false}));
  FineMesh mesh;
  mesh.positions.assign(15, Vec3(1.0, 1.0, 1.0));
  std::vector<Vec3> normals;
  fineMeshNormals(topology, mesh, normals);
  for (const Vec3& normal : normals) EXPECT_EQ(normal.norm(), 1.0);
}

}  // namespace
}  // namespace curtain
