// SPDX-License-Identifier: BSD-3-Clause
//
// Corners, edges and triangles of boxes and meshes: all of them, once, with the right bend and the right outside; and
// found in a box as a search through all of them finds them.
#include "obstacles/obstacle_features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>
#include <utility>

#include "contact/bumpy_sphere.h"
#include "obstacles/mesh_loader.h"
#include "obstacles/shapes.h"
#include "obstacles/triangle_mesh.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::bumpySphere;
using curtain_test::kPi;
using curtain_test::Random;

int countOf(const ObstacleFeatures& features, EdgeBend bend) {
  return static_cast<int>(std::count_if(features.edges().begin(), features.edges().end(),
                                        [bend](const ObstacleEdge& edge) { return edge.bend == bend; }));
}

int touchableEdges(const ObstacleFeatures& features) {
  return static_cast<int>(std::count_if(features.edges().begin(), features.edges().end(),
                                        [](const ObstacleEdge& edge) { return edge.touchable; }));
}

int touchableVertices(const ObstacleFeatures& features) {
  return static_cast<int>(std::count_if(features.vertices().begin(), features.vertices().end(),
                                        [](const ObstacleVertex& vertex) { return vertex.touchable; }));
}

/// What holds for the features of any obstacle: names, ends, faces and normals fit together, no edge comes twice.
void checkConsistent(const ObstacleFeatures& features) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const ObstacleEdge& edge : features.edges()) {
    EXPECT_TRUE(edges.insert(std::minmax(edge.vertices[0], edge.vertices[1])).second);
    EXPECT_NEAR(edge.outward.norm(), 1.0, 1e-12);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(features.vertices().at(edge.vertices[k]).position, edge.ends[k]);
      if (edge.touchable) {
        EXPECT_TRUE(features.vertices()[edge.vertices[k]].touchable);
      }
      if (edge.faces[k] == kNoFace) continue;
      const ObstacleTriangle& face = features.triangles().at(edge.faces[k]);
      for (const std::uint32_t vertex : edge.vertices) {
        EXPECT_EQ(std::count(face.vertices.begin(), face.vertices.end(), vertex), 1);
      }
    }
    EXPECT_NE(edge.faces[0], kNoFace);
  }
  for (const ObstacleTriangle& triangle : features.triangles()) {
    EXPECT_NEAR(triangle.normal.norm(), 1.0, 1e-12);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(features.vertices().at(triangle.vertices[k]).position, triangle.corners[k]);
      EXPECT_NEAR(triangle.normal.dot(triangle.corners[k] - triangle.corners[0]), 0.0, 1e-12);
    }
  }
  for (const ObstacleVertex& vertex : features.vertices()) EXPECT_NEAR(vertex.outward.norm(), 1.0, 1e-12);
}

/// Corners of a square and what hangs on them, side 1.
TriangleMeshShape squareFold(double angle) {  // two squares that share the edge along y; the second turned up by angle
  ShapeTriangles mesh;
  for (const double y : {0.0, 1.0}) {
    mesh.corners.emplace_back(-1.0, y, 0.0);
    mesh.corners.emplace_back(0.0, y, 0.0);
    mesh.corners.emplace_back(std::cos(angle), y, std::sin(angle));
  }
  mesh.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
  return TriangleMeshShape(mesh);
}

const ObstacleEdge* edgeThrough(const ObstacleFeatures& features, const Vec3& middle) {
  for (const ObstacleEdge& edge : features.edges()) {
    if ((0.5 * (edge.ends[0] + edge.ends[1]) - middle).norm() < 1e-12) return &edge;
  }
  return nullptr;
}

/// An L of three unit cubes turned about z: one groove of length 1 at (0, 0, z).
ShapeTriangles angleBar() {
  const Eigen::Vector2d outline[] = {{0, 0},   {0, 1},  {-1, 1},
                                     {-1, -1}, {1, -1}, {1, 0}};  // counter-clockwise from above
  ShapeTriangles mesh;
  for (const double z : {0.0, 1.0}) {
    for (const Eigen::Vector2d& p : outline) mesh.corners.emplace_back(p.x(), p.y(), z);
  }
  const int fan[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
  for (const auto& t : fan) {
    mesh.triangles.emplace_back(t[0], t[2], t[1]);
    mesh.triangles.emplace_back(6 + t[0], 6 + t[1], 6 + t[2]);
  }
  for (int k = 0; k < 6; ++k) {
    const int next = (k + 1) % 6;
    mesh.triangles.emplace_back(k, next, 6 + next);
    mesh.triangles.emplace_back(k, 6 + next, 6 + k);
  }
  return mesh;
}

TEST(ObstacleFeatures, OfABoxAreItsEdgesAndCorners) {
  for (const double thickness : {0.6, 1e-14}) {
    const BoxShape box(Vec3(1.0, 1.6, thickness));
    const ObstacleFeatures& features = *box.features();
    checkConsistent(features);
    EXPECT_TRUE(features.closed());
    EXPECT_EQ(features.vertices().size(), 8u);
    EXPECT_EQ(features.triangles().size(), 12u);
    ASSERT_EQ(features.edges().size(), 12u);
    for (const ObstacleEdge& edge : features.edges()) {
      EXPECT_EQ(edge.bend, EdgeBend::kConvex);
      EXPECT_TRUE(edge.touchable);
      const Vec3 middle = 0.5 * (edge.ends[0] + edge.ends[1]);
      const Vec3 expected = middle.cwiseSign().normalized();  // one coordinate is 0
      EXPECT_LT((edge.outward - expected).norm(), 1e-15);
    }
    for (const ObstacleVertex& vertex : features.vertices()) {
      EXPECT_TRUE(vertex.touchable);
      EXPECT_LT((vertex.outward - vertex.position.cwiseSign().normalized()).norm(), 1e-15);
    }
    for (const ObstacleTriangle& triangle : features.triangles()) {
      EXPECT_EQ(triangle.normal.dot(triangle.corners[0]),
                triangle.normal.cwiseAbs().dot(0.5 * Vec3(1.0, 1.6, thickness)));
      const Vec3 winding = (triangle.corners[1] - triangle.corners[0]).cross(triangle.corners[2] - triangle.corners[0]);
      EXPECT_GT(winding.dot(triangle.normal), 0.0);
    }
  }
}

TEST(ObstacleFeatures, OnlyBoxesAndMeshesHaveThem) {
  EXPECT_EQ(SphereShape(1.0).features(), nullptr);
  EXPECT_EQ(CylinderShape(1.0, 1.0).features(), nullptr);
  EXPECT_EQ(CapsuleShape(1.0, 1.0).features(), nullptr);
  EXPECT_EQ(PlaneShape().features(), nullptr);
  EXPECT_NE(TriangleMeshShape(angleBar()).features(), nullptr);
  const BoxShape box(Vec3::Ones());
  EXPECT_EQ(box.convex(), &box);
  EXPECT_EQ(TriangleMeshShape(angleBar()).convex(), nullptr);
}

TEST(ObstacleFeatures, AGrooveOfASolidIsNotTouched) {
  for (const bool inward : {false, true}) {  // the mesh turns itself outward
    ShapeTriangles bar = angleBar();
    if (inward) {
      for (Eigen::Vector3i& triangle : bar.triangles) std::swap(triangle[1], triangle[2]);
    }
    const TriangleMeshShape solid(bar);
    ASSERT_TRUE(solid.watertight());
    const ObstacleFeatures& features = *solid.features();
    checkConsistent(features);
    EXPECT_EQ(countOf(features, EdgeBend::kConcave), 1);
    EXPECT_EQ(countOf(features, EdgeBend::kConvex), 17);  // 18 edges of a prism over a hexagon, less the groove
    EXPECT_EQ(touchableEdges(features), 17);
    EXPECT_EQ(touchableVertices(features), 12);  // at the groove's ends two ridges meet
    const ObstacleEdge* groove = edgeThrough(features, Vec3(0.0, 0.0, 0.5));
    ASSERT_NE(groove, nullptr);
    EXPECT_EQ(groove->bend, EdgeBend::kConcave);
    EXPECT_FALSE(groove->touchable);
    EXPECT_LT((groove->outward - Vec3(1.0, 1.0, 0.0).normalized()).norm(), 1e-15);
  }
}

TEST(ObstacleFeatures, EveryBendOfAShellIsTouched) {
  for (const double angle : {0.5, -0.5, 3.0, -3.0}) {
    const TriangleMeshShape shell = squareFold(angle);
    const ObstacleFeatures& features = *shell.features();
    checkConsistent(features);
    EXPECT_FALSE(features.closed());
    const ObstacleEdge* fold = edgeThrough(features, Vec3(0.0, 0.5, 0.0));
    ASSERT_NE(fold, nullptr);
    EXPECT_EQ(fold->bend, angle > 0.0 ? EdgeBend::kConcave : EdgeBend::kConvex);
    EXPECT_TRUE(fold->touchable);
    EXPECT_EQ(countOf(features, EdgeBend::kBoundary), 6);
    EXPECT_EQ(countOf(features, EdgeBend::kFlat), 2);
    EXPECT_EQ(touchableEdges(features), 7);
    const ObstacleEdge* rim = edgeThrough(features, Vec3(-1.0, 0.5, 0.0));
    ASSERT_NE(rim, nullptr);
    EXPECT_EQ(rim->outward, Vec3(0.0, 0.0, 1.0));
    EXPECT_EQ(rim->faces[1], kNoFace);
  }
  const TriangleMeshShape flat = squareFold(0.0);
  EXPECT_EQ(countOf(*flat.features(), EdgeBend::kFlat), 3);
  EXPECT_EQ(touchableEdges(*flat.features()), 6);
}

TEST(ObstacleFeatures, OfAShellDoNotDependOnHowFacesAreWound) {
  ShapeTriangles mesh;
  mesh.corners = {{0, 0, 0}, {0, 1, 0}, {1, 0.5, 0}, {-1, 0.5, 0}, {0, 0.5, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}};  // coplanar, wound against each other
  const TriangleMeshShape pair(mesh);
  checkConsistent(*pair.features());
  EXPECT_EQ(edgeThrough(*pair.features(), Vec3(0.0, 0.5, 0.0))->bend, EdgeBend::kFlat);
  mesh.triangles.emplace_back(0, 1, 4);
  const TriangleMeshShape branch(mesh);
  checkConsistent(*branch.features());
  EXPECT_EQ(branch.features()->edges().size(), 7u);
  EXPECT_EQ(edgeThrough(*branch.features(), Vec3(0.0, 0.5, 0.0))->bend, EdgeBend::kBranch);
  EXPECT_EQ(touchableEdges(*branch.features()), 7);
}

// A cube with a sliver: the edge whose neighbour it was is a cube's edge, or flat, but no rim.
TEST(ObstacleFeatures, SliversLeaveNoRims) {
  const std::string path = std::string(CURTAIN_SOURCE_DIR) + "/test/meshes/cube_sliver.stl";
  const TriangleMeshShape cube(loadMesh(path, Vec3::Ones(), "cube"));
  ASSERT_TRUE(cube.watertight());
  const ObstacleFeatures& features = *cube.features();
  checkConsistent(features);
  EXPECT_EQ(countOf(features, EdgeBend::kBoundary), 0);
  EXPECT_EQ(countOf(features, EdgeBend::kConcave), 0);
  double ridges = 0.0;
  for (const ObstacleEdge& edge : features.edges()) {
    if (edge.bend == EdgeBend::kConvex) ridges += (edge.ends[1] - edge.ends[0]).norm();
  }
  const double side = cube.bounds().sizes().x();
  EXPECT_GE(ridges, 12.0 * side - 1e-9);  // an edge split by the sliver's corner may be there whole, too
}

// A T-junction in the middle of a face, closed by a triangle without area: the long edge beside it lost its neighbour.
TEST(ObstacleFeatures, ATJunctionInAFaceIsFlat) {
  ShapeTriangles cube = BoxShape(Vec3(2.0, 2.0, 2.0)).triangles();
  ASSERT_EQ(cube.triangles[2], Eigen::Vector3i(4, 5, 7));
  cube.corners.emplace_back(0.0, 0.0, 1.0);
  cube.triangles[2] = {4, 5, 8};
  cube.triangles.emplace_back(5, 7, 8);
  cube.triangles.emplace_back(4, 8, 7);
  const TriangleMeshShape solid(cube);
  ASSERT_TRUE(solid.watertight());
  const ObstacleFeatures& features = *solid.features();
  checkConsistent(features);
  EXPECT_EQ(features.triangles().size(), 13u);
  EXPECT_EQ(countOf(features, EdgeBend::kConvex), 12);
  EXPECT_EQ(countOf(features, EdgeBend::kFlat), 9);  // five diagonals, the sixth in one piece and in two, one across
  EXPECT_EQ(touchableEdges(features), 12);
  EXPECT_EQ(touchableVertices(features), 8);
}

// The bend of an edge against the solid itself: beside a convex edge the mean of its faces' middles is inside.
TEST(ObstacleFeatures, BendsAgreeWithTheInsideOfTheSolid) {
  const TriangleMeshShape solid(bumpySphere(24, 40, 0.3));
  ASSERT_TRUE(solid.watertight());
  const ObstacleFeatures& features = *solid.features();
  checkConsistent(features);
  EXPECT_EQ(features.vertices().size() - features.edges().size() + features.triangles().size(), 2u);  // Euler
  int concave = 0;
  for (const ObstacleEdge& edge : features.edges()) {
    const Vec3 middle = 0.5 * (edge.ends[0] + edge.ends[1]);
    Vec3 beside = Vec3::Zero();
    for (const std::uint32_t face : edge.faces) {
      const auto& corners = features.triangles().at(face).corners;
      Vec3 inward = (corners[0] + corners[1] + corners[2]) / 3.0 - middle;
      const Vec3 along = (edge.ends[1] - edge.ends[0]).normalized();
      inward -= along.dot(inward) * along;
      beside += 0.5 * (middle + 1e-3 * inward.normalized());
    }
    SurfacePoint surface;
    ASSERT_TRUE(solid.query(beside, beside, 1.0, surface));
    EXPECT_EQ(edge.bend, surface.distance < 0.0 ? EdgeBend::kConvex : EdgeBend::kConcave) << surface.distance;
    const Vec3 above = middle + 1e-6 * edge.outward;
    ASSERT_TRUE(solid.query(above, above, 1.0, surface));
    EXPECT_GT(surface.distance, 0.0);
    concave += edge.bend == EdgeBend::kConcave;
  }
  EXPECT_GT(concave, 100);
}

template <typename Feature, typename BoxOf>
std::set<std::uint32_t> searchAll(const std::vector<Feature>& features, const Eigen::AlignedBox3d& box, BoxOf&& boxOf) {
  std::set<std::uint32_t> found;
  for (std::uint32_t n = 0; n < features.size(); ++n) {
    if (box.intersects(boxOf(features[n]))) found.insert(n);
  }
  return found;
}

TEST(ObstacleFeatures, AreFoundInABoxOnceAndAll) {
  const TriangleMeshShape solid(bumpySphere(20, 30, 0.3));
  const BoxShape box_shape(Vec3(1.0, 1.6, 0.6));
  const TriangleMeshShape fold = squareFold(0.5);
  Random random(1);
  std::size_t total = 0;
  for (const ObstacleFeatures* features : {solid.features(), box_shape.features(), fold.features()}) {
    for (int n = 0; n < 500; ++n) {
      const double size = random.between(0.0, n % 2 == 0 ? 0.1 : 1.5);
      Eigen::AlignedBox3d box(random.inBox(1.2));
      box.extend(Vec3(box.min() + size * Vec3::Ones()));
      const std::size_t some = static_cast<std::size_t>(n) % features->vertices().size();
      if (n % 10 == 0) box = Eigen::AlignedBox3d(features->vertices()[some].position);
      std::set<std::uint32_t> vertices, edges, triangles;
      features->forEachVertexIn(box, [&](std::uint32_t index, const ObstacleVertex& vertex) {
        EXPECT_TRUE(vertices.insert(index).second);
        EXPECT_EQ(&vertex, &features->vertices()[index]);
      });
      features->forEachEdgeIn(box, [&](std::uint32_t index, const ObstacleEdge& edge) {
        EXPECT_TRUE(edges.insert(index).second);
        EXPECT_EQ(&edge, &features->edges()[index]);
      });
      features->forEachTriangleIn(box, [&](std::uint32_t index, const ObstacleTriangle& triangle) {
        EXPECT_TRUE(triangles.insert(index).second);
        EXPECT_EQ(&triangle, &features->triangles()[index]);
      });
      EXPECT_EQ(vertices, searchAll(features->vertices(), box,
                                    [](const ObstacleVertex& v) { return Eigen::AlignedBox3d(v.position); }));
      EXPECT_EQ(edges, searchAll(features->edges(), box, [](const ObstacleEdge& e) {
                  return Eigen::AlignedBox3d(e.ends[0]).extend(e.ends[1]);
                }));
      EXPECT_EQ(triangles, searchAll(features->triangles(), box, [](const ObstacleTriangle& t) {
                  return Eigen::AlignedBox3d(t.corners[0]).extend(t.corners[1]).extend(t.corners[2]);
                }));
      total += vertices.size() + edges.size() + triangles.size();
    }
  }
  EXPECT_GT(total, 10000u);
}

TEST(ObstacleFeatures, NoneInEmptyAndNanBoxesAllInInfiniteOnes) {
  const BoxShape shape(Vec3::Ones());
  int found = 0;
  const auto count = [&](std::uint32_t, const auto&) { ++found; };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Vec3 no_place(nan, nan, nan);
  for (const Eigen::AlignedBox3d& box : {Eigen::AlignedBox3d(), Eigen::AlignedBox3d(no_place, no_place)}) {
    shape.features()->forEachVertexIn(box, count);
    shape.features()->forEachEdgeIn(box, count);
    shape.features()->forEachTriangleIn(box, count);
  }
  EXPECT_EQ(found, 0);
  shape.features()->forEachEdgeIn(Eigen::AlignedBox3d(Vec3::Constant(-infinity), Vec3::Constant(infinity)), count);
  EXPECT_EQ(found, 12);
}

// Looking into a box of a few edges' size takes as much in a mesh of 200000 triangles as in one of 2000: places of the
// tree that are looked at, which every edge would be without it.
TEST(ObstacleFeatures, OfALargeMeshAreFoundByLookingAtFew) {
  const auto placesPerBox = [](int around, int up) {
    const ObstacleFeatures features(analyseMesh(bumpySphere(around, up, 0.3)), FlatEdges::kKeep);
    std::vector<Eigen::AlignedBox3d> boxes;
    for (const ObstacleEdge& edge : features.edges())
      boxes.push_back(Eigen::AlignedBox3d(edge.ends[0]).extend(edge.ends[1]));
    const BoxTree tree(boxes);
    Random random(2);
    std::size_t places = 0;
    constexpr int kBoxes = 2000;
    for (int n = 0; n < kBoxes; ++n) {
      const auto near = static_cast<std::size_t>(random.between(0.0, static_cast<double>(features.edges().size())));
      const Vec3 centre = features.edges()[near].ends[0], half = Vec3::Constant(6.0 / around);
      const Eigen::AlignedBox3d box(Vec3(centre - half), Vec3(centre + half));
      tree.forEachRunIn(box, [&](std::uint32_t first, std::uint32_t last) { places += last - first; });
    }
    return static_cast<double>(places) / kBoxes;
  };
  const double small = placesPerBox(32, 32), large = placesPerBox(318, 316);
  std::printf("places looked at in a box: %.1f of 2000 triangles, %.1f of 200000\n", small, large);
  EXPECT_GT(small, 0.0);
  EXPECT_LT(large, 2.0 * small);
}

}  // namespace
}  // namespace curtain
