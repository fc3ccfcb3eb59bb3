// SPDX-License-Identifier: BSD-3-Clause
//
// Meshes give the same answers as a search through all triangles and as the analytic shapes they approximate;
// closed ones know their inside, open ones the side a node came from.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <utility>

#include "contact/bumpy_sphere.h"
#include "contact/shapes/shapes.h"
#include "contact/shapes/triangle_mesh.h"
#include "testing.h"

namespace curtain {
namespace {

using namespace curtain_test;

using curtain_test::bumpySphere;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Coordinates here are below 4 m: a handful of roundings of 4.4e-16 each stay below this [m].
constexpr double kRounding = 1e-14;

/// Square of n x n cells, side 1 around the origin, in z = height.
ShapeTriangles sheet(int n, double height) {
  ShapeTriangles mesh;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      mesh.corners.emplace_back(static_cast<double>(j) / n - 0.5, static_cast<double>(i) / n - 0.5, height);
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j;
      mesh.triangles.emplace_back(a, a + 1, a + n + 2);
      mesh.triangles.emplace_back(a, a + n + 2, a + n + 1);
    }
  }
  return mesh;
}

const Vec3& cornerOf(const ShapeTriangles& mesh, std::size_t t, int i) {
  return mesh.corners[static_cast<std::size_t>(mesh.triangles[t][i])];
}

/// Distance to a triangle by an independent formula: plane distance if the foot is inside, else nearest of the edges.
double triangleDistance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a).normalized();
  const Vec3 foot = p - normal.dot(p - a) * normal;
  const auto inner = [&](const Vec3& u, const Vec3& v) { return normal.dot((v - u).cross(foot - u)) >= 0.0; };
  if (inner(a, b) && inner(b, c) && inner(c, a)) {
    return std::abs(normal.dot(p - a));
  }
  const auto segment = [&p](const Vec3& u, const Vec3& v) {
    const double t = std::min(1.0, std::max(0.0, (p - u).dot(v - u) / (v - u).squaredNorm()));
    return (p - (u + t * (v - u))).norm();
  };
  return std::min({segment(a, b), segment(b, c), segment(c, a)});
}

double bruteDistance(const ShapeTriangles& mesh, const Vec3& p) {
  double nearest = kInfinity;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    nearest = std::min(nearest, triangleDistance(p, cornerOf(mesh, t, 0), cornerOf(mesh, t, 1), cornerOf(mesh, t, 2)));
  }
  return nearest;
}

/// Turns around the point that the mesh makes (1 inside, 0 outside), by solid angles (Van Oosterom, Strackee 1983).
double windingNumber(const ShapeTriangles& mesh, const Vec3& p) {
  double angle = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = cornerOf(mesh, t, 0) - p;
    const Vec3 b = cornerOf(mesh, t, 1) - p;
    const Vec3 c = cornerOf(mesh, t, 2) - p;
    angle += 2.0 * std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                     b.dot(c) * a.norm() + c.dot(a) * b.norm());
  }
  return angle / (4.0 * kPi);
}

TEST(Mesh, DistanceAndSignAgreeWithAllTriangles) {
  const ShapeTriangles mesh = bumpySphere(14, 20, 0.3);
  const TriangleMeshShape shape(mesh);
  ASSERT_TRUE(shape.watertight());
  Random random(11);
  int inside = 0;
  for (int k = 0; k < 4000; ++k) {
    const Vec3 point = random.inBox(1.6);
    SurfacePoint surface;
    ASSERT_TRUE(shape.query(point, point, 10.0, surface)) << point.transpose();
    // Both formulas round in coordinates below 4 m.
    EXPECT_NEAR(std::abs(surface.distance), bruteDistance(mesh, point), 1e-12) << point.transpose();
    EXPECT_EQ(surface.distance<0.0, windingNumber(mesh, point)> 0.5) << point.transpose();
    EXPECT_NEAR(surface.normal.norm(), 1.0, kRounding);
    inside += surface.distance < 0.0;
  }
  EXPECT_GT(inside, 200);
  EXPECT_LT(inside, 3800);
}

TEST(Mesh, ReachFindsExactlyWhatLiesWithinIt) {
  const ShapeTriangles mesh = bumpySphere(14, 20, 0.3);
  const TriangleMeshShape shape(mesh);
  Random random(11);
  int found = 0;
  for (int k = 0; k < 6000; ++k) {
    const Vec3 point = random.inBox(1.6);
    const double reach = random.between(0.0, 0.3);
    SurfacePoint surface;
    SurfacePoint unbounded;
    ASSERT_TRUE(shape.query(point, point, 10.0, unbounded));
    const bool within = shape.query(point, point, reach, surface);
    EXPECT_EQ(within, unbounded.distance <= reach) << point.transpose() << " reach " << reach;
    if (within) {
      ++found;
      EXPECT_EQ(surface.distance, unbounded.distance);  // the same triangle by the same arithmetic
    }
  }
  EXPECT_GT(found, 300);
}

TEST(Mesh, TreeAnswersAsAllTrianglesForRandomSoups) {
  Random random(11);
  for (const int count : {1, 2, 5, 17, 400}) {
    ShapeTriangles soup;
    for (int t = 0; t < count; ++t) {
      const Vec3 place = random.inBox(1.0);
      for (int i = 0; i < 3; ++i) {
        soup.corners.push_back(place + random.inBox(0.2));
      }
      soup.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
    }
    const TriangleMeshTree tree(soup);
    for (int k = 0; k < 1000; ++k) {
      const Vec3 point = random.inBox(2.0);
      NearestTriangle nearest;
      ASSERT_TRUE(tree.nearest(point, kInfinity, nearest));
      const double brute = bruteDistance(soup, point);
      EXPECT_NEAR(std::sqrt(nearest.distance_squared), brute, 1e-12);  // roundings of coordinates below 4 m
      // Never a miss: just within the limit it is found, just beyond it is not.
      EXPECT_TRUE(tree.nearest(point, std::pow(brute + 1e-9, 2), nearest));
      EXPECT_FALSE(tree.nearest(point, std::pow(brute - 1e-9, 2), nearest)) << brute;
    }
  }
}

/// Corners lie on a lattice and points on its halves: many triangles are equally far.
TEST(Mesh, TrianglesNearAnswerAsTheTree) {
  Random random(11);
  const auto halves = [&](double half) { return Vec3((4.0 * random.inBox(half)).array().round() / 4.0); };
  int ties = 0, held = 0;
  for (const int count : {1, 5, 17, 400}) {
    ShapeTriangles soup;
    while (static_cast<int>(soup.triangles.size()) < count) {
      const Vec3 a = halves(1.0), b = a + halves(0.5), c = a + halves(0.5);
      if ((b - a).cross(c - a).norm() == 0.0) continue;
      const int first = static_cast<int>(soup.corners.size());
      soup.corners.insert(soup.corners.end(), {a, b, c});
      soup.triangles.emplace_back(first, first + 1, first + 2);
    }
    const TriangleMeshTree tree(soup);
    Vec3 point = Vec3::Zero();
    NearTriangles near;
    for (int k = 0; k < 8000; ++k) {
      if (k % 50 == 0)
        point = halves(2.0);
      else if (k % 2 == 0)
        point += random.inBox(0.1);
      else
        point = (8.0 * point).array().round() / 8.0;
      const double limit = std::pow(random.between(0.0, 1.0), 2);
      const double room = 0.1 * (k % 7);
      const Vec3 centre = near.centre;
      NearestTriangle sought, found;
      const bool is_near = tree.nearest(point, limit, sought);
      ASSERT_EQ(tree.nearest(point, limit, room, near, found), is_near) << point.transpose();
      held += near.centre == centre && centre != point;
      if (!is_near) continue;
      EXPECT_EQ(found.triangle, sought.triangle) << point.transpose();
      EXPECT_EQ(found.distance_squared, sought.distance_squared);
      EXPECT_EQ(found.point, sought.point);
      int as_near = 0;
      for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        const NearestTriangle one =
            nearestOnTriangle(point, cornerOf(soup, t, 0), cornerOf(soup, t, 1), cornerOf(soup, t, 2));
        as_near += one.distance_squared == sought.distance_squared;
        EXPECT_FALSE(one.distance_squared == sought.distance_squared && t < sought.triangle);
      }
      ties += as_near > 1;
    }
  }
  EXPECT_GT(ties, 200);
  EXPECT_GT(held, 1000);
}

/// First fraction at which from -> to meets a triangle (Moeller, Trumbore 1997, and nothing else); > 1: none.
double bruteHit(const ShapeTriangles& mesh, const Vec3& from, const Vec3& to, double& margin) {
  double first = 2.0;
  margin = kInfinity;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 ab = cornerOf(mesh, t, 1) - cornerOf(mesh, t, 0);
    const Vec3 ac = cornerOf(mesh, t, 2) - cornerOf(mesh, t, 0);
    const Vec3 cross = (to - from).cross(ac);
    const double det = ab.dot(cross);
    const Vec3 start = from - cornerOf(mesh, t, 0);
    const double u = start.dot(cross) / det;
    const double v = (to - from).dot(start.cross(ab)) / det;
    const double fraction = ac.dot(start.cross(ab)) / det;
    margin = std::min(margin, std::max({-u, -v, u + v - 1.0, -fraction, fraction - 1.0}) > 1e-9
                                  ? kInfinity
                                  : std::abs(std::max({-u, -v, u + v - 1.0, -fraction, fraction - 1.0})));
    if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && fraction >= 0.0 && fraction < first) {
      first = fraction;
    }
  }
  return first;
}

TEST(Mesh, FirstHitAgreesWithAllTriangles) {
  const ShapeTriangles mesh = bumpySphere(14, 20, 0.3);
  const TriangleMeshTree tree(mesh);
  Random random(11);
  int hits = 0;
  for (int k = 0; k < 5000; ++k) {
    const Vec3 from = random.inBox(1.5);
    const Vec3 to = random.inBox(1.5);
    double margin = 0.0;
    const double expected = bruteHit(mesh, from, to, margin);
    if (margin < 1e-9) {
      continue;  // through an edge, up to rounding: either answer is right
    }
    TriangleHit hit;
    ASSERT_EQ(tree.firstHit(from, to, 0.0, hit), expected <= 1.0) << from.transpose() << " -> " << to.transpose();
    if (expected <= 1.0) {
      ++hits;
      // The fraction is a quotient by the cosine of incidence; 1e-16 / 1e-9 allows all that margin did.
      EXPECT_NEAR(hit.fraction, expected, 1e-7);
    }
  }
  EXPECT_GT(hits, 500);
}

TEST(Mesh, NoSegmentSlipsBetweenTriangles) {
  // Aimed exactly at edges and corners, from outside to the centre.
  const ShapeTriangles mesh = bumpySphere(14, 20, 0.3);
  const TriangleMeshTree tree(mesh);
  Random random(11);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int e = 0; e < 3; ++e) {
      for (const double share : {0.0, 0.5, random.between(0.0, 1.0)}) {
        const Vec3 target = cornerOf(mesh, t, e) + share * (cornerOf(mesh, t, (e + 1) % 3) - cornerOf(mesh, t, e));
        TriangleHit hit;
        EXPECT_TRUE(tree.firstHit(3.0 * target, Vec3::Zero(), 0.0, hit)) << target.transpose();
        EXPECT_TRUE(tree.firstHit(Vec3::Zero(), 3.0 * target, 0.0, hit)) << target.transpose();
      }
    }
  }
}

TEST(Mesh, BoxOfTrianglesEqualsTheAnalyticBox) {
  const BoxShape box(Vec3(1.0, 1.6, 0.6));
  const TriangleMeshShape mesh(box.triangles());
  ASSERT_TRUE(mesh.watertight());
  Random random(11);
  for (int k = 0; k < 20000; ++k) {
    const Vec3 from = random.inBox(1.2);
    const Vec3 to = k % 2 == 0 ? random.inBox(1.2) : Vec3(from + random.inBox(0.1));
    const double reach = random.between(0.0, 0.5);
    SurfacePoint expected;
    SurfacePoint actual;
    const bool found = box.query(from, to, reach, expected);
    ASSERT_EQ(mesh.query(from, to, reach, actual), found) << from.transpose() << " -> " << to.transpose();
    if (found) {
      EXPECT_NEAR(actual.distance, expected.distance, kRounding) << from.transpose() << " -> " << to.transpose();
      // Directions to an edge at a distance above 1e-6 m round by 4.4e-16 / 1e-6.
      EXPECT_NEAR((actual.normal - expected.normal).norm(), 0.0, 1e-9) << from.transpose() << " -> " << to.transpose();
    }
  }
}

TEST(Mesh, FineSphereOfTrianglesApproachesTheAnalyticSphere) {
  const TriangleMeshShape mesh(bumpySphere(96, 192, 0.0));
  const SphereShape sphere(1.0);
  Random random(11);
  // Cells of pi/96 by pi/96, so circles around a triangle have radius up to 0.0327 / sqrt 2 = 0.0232 m: sagitta
  // 0.0232^2 / 2 = 2.7e-4 m.
  for (int k = 0; k < 5000; ++k) {
    const Vec3 point = random.inBox(1.5);
    SurfacePoint surface;
    ASSERT_TRUE(mesh.query(point, point, 10.0, surface));
    const double error = surface.distance - sphere.nearest(point).distance;
    EXPECT_GE(error, -kRounding) << point.transpose();  // inscribed
    EXPECT_LE(error, 2.7e-4) << point.transpose();
  }
}

TEST(Mesh, NormalIsTheGradientOfTheDistance) {
  const TriangleMeshShape shape(bumpySphere(14, 20, 0.3));
  const auto at = [&shape](const Vec3& p) {
    SurfacePoint surface;
    EXPECT_TRUE(shape.query(p, p, 10.0, surface));
    return surface;
  };
  Random random(11);
  const double h = 1e-6;
  int compared = 0;
  for (int k = 0; k < 3000; ++k) {
    const Vec3 point = random.inBox(1.6);
    Vec3 gradient;
    bool smooth = true;
    for (int i = 0; i < 3; ++i) {
      const SurfacePoint plus = at(point + h * Vec3::Unit(i));
      const SurfacePoint minus = at(point - h * Vec3::Unit(i));
      gradient[i] = (plus.distance - minus.distance) / (2.0 * h);
      smooth = smooth && plus.normal.dot(minus.normal) > 1.0 - 1e-6;  // else the medial axis, or an edge nearby
    }
    if (!smooth) {
      continue;
    }
    ++compared;
    // Turning by at most sqrt(2e-6) over 2 h keeps the curvature below 700 / m: h * 700 = 7e-4 at changes of region;
    // rounding 4e-16 / h.
    EXPECT_LT((gradient - at(point).normal).norm(), 1e-3) << point.transpose();
  }
  EXPECT_GT(compared, 2800);
}

TEST(Mesh, OnTheSurfaceTheNormalIsTheFacesOwn) {
  const ShapeTriangles mesh = bumpySphere(14, 20, 0.3);
  const TriangleMeshShape shape(mesh);
  Random random(11);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double u = random.between(0.1, 0.4);
    const double v = random.between(0.1, 0.4);
    const Vec3 ab = cornerOf(mesh, t, 1) - cornerOf(mesh, t, 0);
    const Vec3 ac = cornerOf(mesh, t, 2) - cornerOf(mesh, t, 0);
    const Vec3 normal = ab.cross(ac).normalized();
    for (const double height : {0.0, 1e-16, -1e-12, 1e-12}) {
      const Vec3 point = cornerOf(mesh, t, 0) + u * ab + v * ac + height * normal;
      SurfacePoint surface;
      ASSERT_TRUE(shape.query(point, point, 1e-6, surface));
      EXPECT_NEAR(surface.distance, height, 1e-15);  // four roundings of coordinates below 2 m
      EXPECT_NEAR((surface.normal - normal).norm(), 0.0, kRounding);
    }
    // At corners and in the middle of edges: a unit vector that looks away from this face's inside.
    for (const Vec3& point : {cornerOf(mesh, t, 0), Vec3(cornerOf(mesh, t, 0) + 0.5 * ab)}) {
      SurfacePoint surface;
      ASSERT_TRUE(shape.query(point, point, 1e-6, surface));
      EXPECT_NEAR(surface.distance, 0.0, 1e-15);
      EXPECT_NEAR(surface.normal.norm(), 1.0, kRounding);
      EXPECT_GT(surface.normal.dot(normal), 0.0);
    }
  }
}

TEST(Mesh, WindingDoesNotMatterToAClosedMesh) {
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

TEST(Mesh, CavityIsOutside) {
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

TEST(Mesh, ThinPlateGivesANodeBackToTheSideItCameFrom) {
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

TEST(Mesh, OpenSheetRemembersTheSide) {
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

TEST(Mesh, DoubledSheetIsAShell) {
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

TEST(Mesh, SliversAndDegeneratesKeepAClosedMeshClosed) {
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

TEST(Mesh, SpikeWithOneFinelySplitSideHasTheRightSignAtItsTip) {
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

TEST(Mesh, SliverInASharpEdgeKeepsTheSignThere) {
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

TEST(Mesh, HugeAndTinyInputsStayFinite) {
  const TriangleMeshShape solid(BoxShape(Vec3(1.0, 1.0, 1.0)).triangles());
  const TriangleMeshShape shell(sheet(3, 0.0));
  for (const TriangleMeshShape* shape : {&solid, &shell}) {
    for (const double size : {0.0, 1e-320, 1e-160, 1e-12, 1e12, 1e100}) {
      for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, 0, -1), Vec3(0.6, 0.64, -0.48)}) {
        for (const Vec3& previous : {Vec3(Vec3::Zero()), Vec3(0.1, 0.2, 3.0), Vec3(size * direction)}) {
          SurfacePoint surface;
          if (shape->query(previous, size * direction, 1e120, surface)) {
            EXPECT_TRUE(std::isfinite(surface.distance)) << size;
            EXPECT_NEAR(surface.normal.norm(), 1.0, 1e-12) << size;
          } else {
            ADD_FAILURE() << "nothing within 1e120 m of " << size;
          }
        }
      }
    }
  }
}

TEST(Mesh, AnswersForTwoHundredThousandTriangles) {
  const ShapeTriangles mesh = bumpySphere(318, 316, 0.2);
  ASSERT_GT(mesh.triangles.size(), 200000u);
  const TriangleMeshShape shape(mesh);
  Random random(11);
  const int count = 100000;
  std::vector<Vec3> near_points;
  std::vector<Vec3> anywhere;
  for (int k = 0; k < count; ++k) {
    const Vec3 direction = random.inBox(1.0).normalized();
    near_points.push_back(random.between(0.95, 1.1) * direction);
    anywhere.push_back(random.inBox(1.3));
  }
  const auto foundOf = [&](const std::vector<Vec3>& points) {
    int found = 0;
    SurfacePoint surface;
    for (const Vec3& point : points) found += shape.query(point, point, 0.02, surface);
    return found;
  };
  const int found_anywhere = foundOf(anywhere);
  EXPECT_GT(foundOf(near_points), count / 4);
  EXPECT_GT(found_anywhere, count / 10);
  EXPECT_LT(found_anywhere, count);
  for (std::size_t k = 0; k < 20; ++k) {
    SurfacePoint surface;
    ASSERT_TRUE(shape.query(anywhere[k], anywhere[k], 5.0, surface));
    EXPECT_NEAR(std::abs(surface.distance), bruteDistance(mesh, anywhere[k]), 1e-12);
  }
}

}  // namespace
}  // namespace curtain
