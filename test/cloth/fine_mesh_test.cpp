// SPDX-License-Identifier: BSD-3-Clause
//
// The fine mesh is one sheet (a disc, or an annulus where the cloth is closed) of both layers of nodes, wound as the
// node normals point.
#include "curtain_sim/fine_mesh.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "cloth/folds.h"
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

// Both layers, as the simulator would build them without obstacles.
FineMesh build(const Scene& scene, const ClothPattern& pattern, const Field3& position, const Field3& vectors) {
  const FineMeshTopology topology = makeFineMeshTopology(scene.cloth);
  FineMesh mesh;
  mesh.positions.assign(static_cast<std::size_t>(topology.rows * topology.columns), Vec3::Constant(1e9));
  const FoldShape shape(scene.cloth.folds);
  for (int i = 0; i < pattern.grid.rows; ++i) {
    Vec3* const row = mesh.positions.data() + i * topology.columns;
    for (int j = 0; j < pattern.grid.columns; ++j) row[j * topology.folds] = position.at(pattern.grid.index(i, j));
    if (topology.folds == 1) continue;
    for (int j = pattern.grid.closed ? 0 : 1; j < pattern.grid.columns; ++j) {
      const int left = j > 0 ? j - 1 : pattern.grid.columns - 1;
      shape.place(foldArc(pattern, position, vectors, i, j), row + left * topology.folds + 1);
    }
  }
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
      const FineMesh mesh = build(scene, pattern, position, vectors);
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
