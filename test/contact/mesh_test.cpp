// SPDX-License-Identifier: BSD-3-Clause
//
// Meshes give the same answers as a search through all triangles and as the analytic shapes they approximate.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "contact/all_triangles.h"
#include "contact/bumpy_sphere.h"
#include "obstacles/shapes.h"
#include "obstacles/triangle_mesh.h"
#include "testing.h"

namespace curtain {
namespace {

using namespace curtain_test;

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

// What a state from a damaged file may come to within a step, before the step is refused.
TEST(TriangleMesh, IsNowhereNearWhatIsNoPoint) {
  const TriangleMeshShape shape(bumpySphere(12, 14, 0.3));
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  SurfacePoint surface;
  for (const double bad : {nan, infinity, -infinity}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 point(0.1, 0.2, 0.3);
      point[axis] = bad;
      EXPECT_FALSE(shape.query(point, point, 1.0, surface)) << bad << " along axis " << axis;
    }
  }
}

}  // namespace
}  // namespace curtain
