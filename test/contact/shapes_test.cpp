// SPDX-License-Identifier: BSD-3-Clause
//
// The analytic obstacles give the exact signed distance with its gradient everywhere.
#include "obstacles/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "contact/solids.h"
#include "testing.h"

namespace curtain {
namespace {

using namespace curtain_test;

// Coordinates here are below 4 m: a handful of roundings of 4.4e-16 each stay below this [m].
constexpr double kRounding = 1e-14;

/// A node that does not move: only the distance counts.
bool queryAtRest(const ObstacleShape& shape, const Vec3& point, double reach, SurfacePoint& out) {
  return shape.query(point, point, reach, out);
}

/// Surface samples a step apart by the parametrisations of the solids (not by the code under test).
std::vector<Vec3> sampleSurface(const std::string& name, int n) {
  std::vector<Vec3> samples;
  const auto disc = [&](double radius, double z) {
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j < 2 * n; ++j) {
        const double r = radius * i / n;
        samples.emplace_back(r * std::cos(kPi * j / n), r * std::sin(kPi * j / n), z);
      }
    }
  };
  const auto tube = [&](double radius, double half) {
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j < 2 * n; ++j) {
        const double angle = kPi * j / n;
        samples.emplace_back(radius * std::cos(angle), radius * std::sin(angle), half * (2.0 * i / n - 1.0));
      }
    }
  };
  const auto ball = [&](double radius, double shift) {  // the halves moved apart by 2 shift
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j < 2 * n; ++j) {
        const double up = kPi * (static_cast<double>(i) / n - 0.5);
        const double ring = radius * std::cos(up);
        samples.emplace_back(ring * std::cos(kPi * j / n), ring * std::sin(kPi * j / n),
                             radius * std::sin(up) + (up < 0.0 ? -shift : shift));
      }
    }
  };
  if (name == "sphere") {
    ball(0.7, 0.0);
  } else if (name == "cylinder") {
    tube(0.5, 0.7);
    disc(0.5, 0.7);
    disc(0.5, -0.7);
  } else if (name == "capsule") {
    tube(0.4, 0.6);
    ball(0.4, 0.6);
  } else if (name == "box") {
    const Vec3 half(0.5, 0.8, 0.3);
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= n; ++j) {
          Vec3 point;
          point[axis] = half[axis];
          point[(axis + 1) % 3] = half[(axis + 1) % 3] * (2.0 * i / n - 1.0);
          point[(axis + 2) % 3] = half[(axis + 2) % 3] * (2.0 * j / n - 1.0);
          samples.push_back(point);
          point[axis] = -half[axis];
          samples.push_back(point);
        }
      }
    }
  }
  return samples;
}

/// Membership by the defining inequalities.
TEST(Shapes, DistanceAgreesWithDenseSamplingOfTheSurface) {
  Random random(7);
  const int n = 150;
  // The nearest sample is at most half a cell's diagonal from the nearest point: edges 2*0.8/150 (box, tube) and
  // pi*0.7/150 (round), so the diagonal is below 0.021 m, half of it 0.0104 m. From a distance d this lengthens the
  // way by at most 0.0104 m, and never shortens it.
  const double spacing = 0.0104;
  for (const char* const name : {"sphere", "box", "cylinder", "capsule"}) {
    const ConvexShape& shape = *kSolids.at(name);
    const std::vector<Vec3> samples = sampleSurface(name, n);
    for (int k = 0; k < 150; ++k) {
      const Vec3 point = random.inBox(1.5);
      double nearest = std::numeric_limits<double>::infinity();
      for (const Vec3& sample : samples) {
        nearest = std::min(nearest, (sample - point).norm());
      }
      const SurfacePoint surface = shape.nearest(point);
      EXPECT_EQ(surface.distance < 0.0, isInside(name, point)) << name << " " << point.transpose();
      EXPECT_LE(std::abs(surface.distance), nearest + kRounding) << name << " " << point.transpose();
      EXPECT_GE(std::abs(surface.distance), nearest - spacing) << name << " " << point.transpose();
    }
  }
}

TEST(Shapes, FootOfTheNormalLiesOnTheSurface) {
  // Together with the sampling this makes the distance exact: no shorter way exists, and this one arrives.
  Random random(7);
  for (const auto& [name, shape] : kSolids) {
    for (int k = 0; k < 5000; ++k) {
      const Vec3 point = random.inBox(2.0);
      const SurfacePoint surface = shape->nearest(point);
      const Vec3 foot = point - surface.distance * surface.normal;
      EXPECT_NEAR(shape->nearest(foot).distance, 0.0, kRounding) << name << " " << point.transpose();
      EXPECT_NEAR(surface.normal.norm(), 1.0, 1e-15) << name;  // two roundings of 1.1e-16 a component
    }
  }
}

TEST(Shapes, NormalIsTheGradientOfTheDistance) {
  Random random(7);
  const double h = 1e-5;
  for (const auto& [name, shape] : kSolids) {
    int compared = 0;
    for (int k = 0; k < 3000; ++k) {
      const Vec3 point = random.inBox(1.5);
      const SurfacePoint surface = shape->nearest(point);
      Vec3 gradient;
      bool smooth = true;
      for (int i = 0; i < 3; ++i) {
        const SurfacePoint plus = shape->nearest(point + h * Vec3::Unit(i));
        const SurfacePoint minus = shape->nearest(point - h * Vec3::Unit(i));
        gradient[i] = (plus.distance - minus.distance) / (2.0 * h);
        // A jump of the normal within h: the medial axis, where there is no gradient.
        smooth = smooth && plus.normal.dot(minus.normal) > 0.99;
      }
      if (!smooth) {
        continue;
      }
      ++compared;
      // Central differences: h^2/6 times the third derivative, 3/r^2 with r the distance to the centre of
      // curvature. normals.dot > 0.99 above keeps r > 14 h, hence 3/(6*14^2) = 2.6e-3 in the worst case next to an
      // axis; at r > 0.01 m it is 5e-7. Rounding: 4e-16/h = 4e-11. Changes of region at edges are C1: h/r = 1e-3.
      const double r = std::max(14.0 * h, std::min(std::abs(surface.distance), point.head<2>().norm()));
      EXPECT_LT((gradient - surface.normal).norm(), h * h / (r * r) + h / r + 1e-9) << name << " " << point.transpose();
    }
    EXPECT_GT(compared, 2900) << name;
  }
}

TEST(Shapes, HaveTheKnownValues) {
  SurfacePoint surface = kSphere.nearest(Vec3(0.0, 2.7, 0.0));
  EXPECT_NEAR(surface.distance, 2.0, kRounding);
  EXPECT_EQ(surface.normal, Vec3(Vec3::UnitY()));
  surface = kBox.nearest(Vec3(0.5 + 0.3, -0.8 - 0.4, 0.0));  // 3-4-5 from an edge
  EXPECT_NEAR(surface.distance, 0.5, kRounding);
  EXPECT_NEAR((surface.normal - Vec3(0.6, -0.8, 0.0)).norm(), 0.0, kRounding);
  surface = kBox.nearest(Vec3(0.1, 0.1, -0.25));
  EXPECT_NEAR(surface.distance, -0.05, kRounding);
  EXPECT_EQ(surface.normal, Vec3(-Vec3::UnitZ()));
  surface = kCylinder.nearest(Vec3(0.0, -0.8, 1.1));  // 3-4-5 from the rim
  EXPECT_NEAR(surface.distance, 0.5, kRounding);
  EXPECT_NEAR((surface.normal - Vec3(0.0, -0.6, 0.8)).norm(), 0.0, kRounding);
  surface = kCapsule.nearest(Vec3(0.3, 0.0, -1.0));  // 3-4-5 from a cap's centre
  EXPECT_NEAR(surface.distance, 0.1, kRounding);
  EXPECT_NEAR((surface.normal - Vec3(0.6, 0.0, -0.8)).norm(), 0.0, kRounding);
  surface = kPlane.nearest(Vec3(3.0, -4.0, -0.25));
  EXPECT_EQ(surface.distance, -0.25);
  EXPECT_EQ(surface.normal, Vec3(Vec3::UnitZ()));
}

TEST(Shapes, CentresAxesEdgesAndCornersHaveAUnitNormalAndTheRightDistance) {
  const std::vector<std::pair<const ConvexShape*, std::pair<Vec3, double>>> cases = {
      {&kSphere, {Vec3::Zero(), -0.7}},
      {&kBox, {Vec3::Zero(), -0.3}},
      {&kCylinder, {Vec3::Zero(), -0.5}},
      {&kCapsule, {Vec3::Zero(), -0.4}},
      {&kCylinder, {Vec3(0.0, 0.0, 0.6), -0.1}},
      {&kCapsule, {Vec3(0.0, 0.0, 0.6), -0.4}},
      {&kCylinder, {Vec3(0.0, 0.0, 0.7), 0.0}},
      {&kCylinder, {Vec3(0.5, 0.0, 0.7), 0.0}},
      {&kBox, {Vec3(0.5, 0.8, 0.3), 0.0}},
      {&kBox, {Vec3(-0.5, 0.8, 0.1), 0.0}},
      {&kPlane, {Vec3::Zero(), 0.0}}};
  for (const auto& [shape, expected] : cases) {
    const SurfacePoint surface = shape->nearest(expected.first);
    EXPECT_NEAR(surface.distance, expected.second, kRounding) << expected.first.transpose();
    EXPECT_NEAR(surface.normal.norm(), 1.0, 1e-15) << expected.first.transpose();
    // The way out leads out: one step along the normal is further out by that step.
    EXPECT_NEAR(shape->nearest(expected.first + 0.01 * surface.normal).distance, expected.second + 0.01, kRounding);
  }
}

TEST(Shapes, TinyAndHugeInputsStayFinite) {
  for (const auto& [name, shape] : kSolids) {
    for (const double size : {0.0, 1e-320, 1e-160, 1e-12, 1.0, 1e12, 1e160, 1e307}) {
      for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0.6, 0.64, -0.48)}) {
        const Vec3 point = size * direction;
        SurfacePoint surface;
        ASSERT_TRUE(queryAtRest(*shape, point, std::numeric_limits<double>::infinity(), surface));
        EXPECT_TRUE(std::isfinite(surface.distance)) << name << " " << size;
        EXPECT_NEAR(surface.normal.norm(), 1.0, 1e-15) << name << " " << size;
        if (size >= 1e12 && name != "plane") {
          // From afar every solid is a point: it is short of the radius by at most its own size, 1.8 m.
          EXPECT_NEAR(surface.distance, size, 2.0 + 1e-15 * size) << name;
        }
        SurfacePoint moved;
        if (shape->query(Vec3(0.1, 0.2, 5.0), point, 0.1, moved)) {
          EXPECT_TRUE(std::isfinite(moved.distance) && moved.normal.allFinite()) << name << " " << size;
        }
      }
    }
  }
  // 1e-12 m on either side of the faces: the sign is right and the distance is a rounding of 0.5 from it.
  SurfacePoint surface = kBox.nearest(Vec3(0.5 + 1e-12, 0.0, 0.0));
  EXPECT_NEAR(surface.distance, 1e-12, 2e-16);
  EXPECT_EQ(surface.normal, Vec3(Vec3::UnitX()));
  surface = kBox.nearest(Vec3(0.5 - 1e-12, 0.0, 0.0));
  EXPECT_NEAR(surface.distance, -1e-12, 2e-16);
}

TEST(Shapes, ReachDecidesOutsideAndNeverInside) {
  SurfacePoint surface;
  EXPECT_TRUE(queryAtRest(kSphere, Vec3(0.75, 0.0, 0.0), 0.06, surface));
  EXPECT_FALSE(queryAtRest(kSphere, Vec3(0.75, 0.0, 0.0), 0.04, surface));
  EXPECT_TRUE(queryAtRest(kSphere, Vec3(0.1, 0.0, 0.0), 0.0, surface));
  EXPECT_NEAR(surface.distance, -0.6, kRounding);
}

double sixVolumes(const ShapeTriangles& shape, bool& closed) {
  std::map<std::pair<int, int>, int> edges;
  double volume = 0.0;
  for (const Eigen::Vector3i& t : shape.triangles) {
    const auto at = [&](int i) { return shape.corners[static_cast<std::size_t>(t[i])]; };
    volume += at(0).dot(at(1).cross(at(2)));
    for (int e = 0; e < 3; ++e) {
      ++edges[{t[e], t[(e + 1) % 3]}];
    }
  }
  closed = true;
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    closed = closed && count == 1 && back != edges.end();
  }
  return volume;
}

TEST(Shapes, TrianglesAreClosedOutwardAndOnTheSurface) {
  const std::map<std::string, double> volumes = {{"sphere", 4.0 / 3.0 * kPi * 0.343},
                                                 {"box", 0.96},
                                                 {"cylinder", kPi * 0.25 * 1.4},
                                                 {"capsule", kPi * 0.16 * 1.2 + 4.0 / 3.0 * kPi * 0.064}};
  for (const auto& [name, volume] : volumes) {
    const ConvexShape& shape = *kSolids.at(name);
    const ShapeTriangles mesh = shape.triangles();
    bool closed = false;
    const double six = sixVolumes(mesh, closed);
    EXPECT_TRUE(closed) << name;
    // Inscribed: 48 segments around and along a meridian each come short of the radius by a factor of at least
    // cos(pi/48), both together, in each of three dimensions: cos^6 = 0.987.
    EXPECT_LE(six / 6.0, volume * (1.0 + 1e-12)) << name;
    EXPECT_GT(six / 6.0, volume * 0.987) << name;
    Eigen::AlignedBox3d box;
    for (const Vec3& corner : mesh.corners) {
      EXPECT_NEAR(shape.nearest(corner).distance, 0.0, kRounding) << name;
      box.extend(corner);
    }
    EXPECT_NEAR((shape.bounds().min() - box.min()).norm() + (shape.bounds().max() - box.max()).norm(), 0.0, kRounding)
        << name;
  }
  for (const Eigen::Vector3i& t : kPlane.triangles().triangles) {
    const ShapeTriangles square = kPlane.triangles();
    const auto at = [&](int i) { return square.corners[static_cast<std::size_t>(t[i])]; };
    EXPECT_GT((at(1) - at(0)).cross(at(2) - at(0)).z(), 0.0);
  }
}

TEST(Shapes, FactoryBuildsEachShapeAndRefusesNonsense) {
  ObstacleParams obstacle;
  obstacle.name = "ball";
  obstacle.radius = 0.5;
  obstacle.length = 1.0;
  obstacle.size = Vec3(1.0, 1.0, 1.0);
  for (const ShapeKind kind :
       {ShapeKind::kSphere, ShapeKind::kBox, ShapeKind::kCylinder, ShapeKind::kCapsule, ShapeKind::kPlane}) {
    obstacle.shape = kind;
    SurfacePoint surface;
    ASSERT_TRUE(queryAtRest(*makeObstacleShape(obstacle), Vec3(0.0, 0.0, -0.125), 0.0, surface));
    EXPECT_LT(surface.distance, 0.0);
  }
  for (const double radius : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    obstacle.shape = ShapeKind::kSphere;
    obstacle.radius = radius;
    try {
      makeObstacleShape(obstacle);
      FAIL() << radius;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("obstacle 'ball': radius must be finite and > 0"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace curtain
