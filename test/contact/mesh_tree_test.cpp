// SPDX-License-Identifier: BSD-3-Clause
//
// The tree of a mesh's triangles finds the nearest and the first hit as a search through all of them does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "contact/all_triangles.h"
#include "contact/bumpy_sphere.h"
#include "obstacles/triangle_mesh_tree.h"

namespace curtain {
namespace {

using namespace curtain_test;

TEST(MeshTree, AnswersAsAllTrianglesForRandomSoups) {
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
TEST(MeshTree, TrianglesNearAnswerAsIt) {
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

TEST(MeshTree, FirstHitAgreesWithAllTriangles) {
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

TEST(MeshTree, NoSegmentSlipsBetweenTriangles) {
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

}  // namespace
}  // namespace curtain
