// SPDX-License-Identifier: BSD-3-Clause
//
// The analytic obstacles give the exact signed distance with its gradient everywhere, and give a node back to the
// side it came from.
#include "contact/shapes/shapes.h"

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
bool isInside(const std::string& name, const Vec3& p) {
  if (name == "sphere") {
    return p.squaredNorm() < 0.49;
  }
  if (name == "box") {
    return std::abs(p.x()) < 0.5 && std::abs(p.y()) < 0.8 && std::abs(p.z()) < 0.3;
  }
  if (name == "rounded box") {
    return (p.cwiseAbs() - Vec3(0.3, 0.4, 0.2)).cwiseMax(0.0).squaredNorm() < 0.04;
  }
  const double radial_squared = p.x() * p.x() + p.y() * p.y();
  if (name == "cylinder") {
    return radial_squared < 0.25 && std::abs(p.z()) < 0.7;
  }
  const double beyond = std::max(std::abs(p.z()) - 0.6, 0.0);
  return radial_squared + beyond * beyond < 0.16;
}

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

TEST(Shapes, NodePressedIntoAThinPlateGoesBackTheWayItCame) {
  const BoxShape plate(Vec3(1.0, 1.0, 0.01));
  SurfacePoint surface;
  // In the lower half: the nearest exit would be below.
  ASSERT_TRUE(plate.query(Vec3(0.1, 0.2, 0.02), Vec3(0.1, 0.2, -0.004), 0.001, surface));
  EXPECT_EQ(surface.normal, Vec3(Vec3::UnitZ()));
  EXPECT_NEAR(surface.distance, -0.009, kRounding);
  // Right through.
  ASSERT_TRUE(plate.query(Vec3(0.1, 0.2, 0.02), Vec3(0.1, 0.2, -0.5), 0.001, surface));
  EXPECT_EQ(surface.normal, Vec3(Vec3::UnitZ()));
  EXPECT_NEAR(surface.distance, -0.505, kRounding);
  // From below, through.
  ASSERT_TRUE(plate.query(Vec3(0.1, 0.2, -0.02), Vec3(0.1, 0.2, 0.5), 0.001, surface));
  EXPECT_EQ(surface.normal, Vec3(-Vec3::UnitZ()));
  // Who was inside already goes out by the nearest exit.
  ASSERT_TRUE(plate.query(Vec3(0.1, 0.2, -0.003), Vec3(0.1, 0.2, -0.004), 0.001, surface));
  EXPECT_EQ(surface.normal, Vec3(-Vec3::UnitZ()));
  EXPECT_NEAR(surface.distance, -0.001, kRounding);
  // Past the rim nothing is crossed.
  EXPECT_FALSE(plate.query(Vec3(0.51, 0.0, 0.02), Vec3(0.51, 0.0, -0.5), 0.001, surface));
}

TEST(Shapes, NodeThatPassedARoundSolidIsHeldByTheTangentPlaneOfTheEntry) {
  SurfacePoint surface;
  // Sphere: in at (-0.7, 0, 0), out beyond.
  ASSERT_TRUE(kSphere.query(Vec3(-1.0, 0.0, 0.0), Vec3(1.0, 0.1 / 3.0, 0.0), 0.001, surface));
  EXPECT_LT(surface.normal.x(), -0.99);
  EXPECT_LT(surface.distance, -1.6);
  // A thin rod crossed at right angles: entry at x = -0.005, current 0.02 beyond the axis.
  const CapsuleShape rod(0.005, 2.0);
  ASSERT_TRUE(rod.query(Vec3(-0.02, 0.0, 0.3), Vec3(0.02, 0.0, 0.3), 0.0, surface));
  EXPECT_NEAR((surface.normal + Vec3::UnitX()).norm(), 0.0, kRounding);
  EXPECT_NEAR(surface.distance, -0.025, kRounding);
  // Past its axis but still inside: back as well.
  ASSERT_TRUE(rod.query(Vec3(-0.02, 0.0, 0.3), Vec3(0.002, 0.0, 0.3), 0.0, surface));
  EXPECT_NEAR(surface.distance, -0.007, kRounding);
  // Before its axis: the nearest exit is the same side, exact distance.
  ASSERT_TRUE(rod.query(Vec3(-0.02, 0.0, 0.3), Vec3(-0.002, 0.0, 0.3), 0.0, surface));
  EXPECT_NEAR(surface.distance, -0.003, kRounding);
  // Cylinder through its ends.
  ASSERT_TRUE(kCylinder.query(Vec3(0.1, 0.0, 1.0), Vec3(0.1, 0.0, -1.0), 0.0, surface));
  EXPECT_EQ(surface.normal, Vec3(Vec3::UnitZ()));
  EXPECT_NEAR(surface.distance, -1.7, kRounding);
  // Capsule through its caps, along the axis.
  ASSERT_TRUE(kCapsule.query(Vec3(0.0, 0.0, 2.0), Vec3(0.0, 0.0, -2.0), 0.0, surface));
  EXPECT_NEAR((surface.normal - Vec3::UnitZ()).norm(), 0.0, kRounding);
  EXPECT_NEAR(surface.distance, -3.0, kRounding);
  // Plane: its distance is the entry's as well.
  ASSERT_TRUE(kPlane.query(Vec3(0.0, 0.0, 1.0), Vec3(5.0, 0.0, -2.0), 0.0, surface));
  EXPECT_EQ(surface.distance, -2.0);
}

/// First change from outside to inside on the way, by marching and bisection with isInside().
bool marchedEntry(const std::string& name, const Vec3& from, const Vec3& to, Vec3& entry) {
  const int steps = 2000;
  for (int i = 0; i < steps; ++i) {
    double in = static_cast<double>(i + 1) / steps;
    if (!isInside(name, from + in * (to - from))) {
      continue;
    }
    double out = static_cast<double>(i) / steps;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (in + out);
      (isInside(name, from + middle * (to - from)) ? in : out) = middle;
    }
    entry = from + in * (to - from);
    return true;
  }
  return false;
}

TEST(Shapes, EntryAgreesWithMarchingAlongTheWay) {
  Random random(7);
  for (const char* const name : {"sphere", "box", "cylinder", "capsule", "rounded box"}) {
    const ConvexShape& shape = *kSolids.at(name);
    int passed = 0;
    for (int k = 0; k < 1500; ++k) {
      const Vec3 from = random.inBox(1.5);
      const Vec3 to = random.inBox(1.5);
      if (isInside(name, from) || isInside(name, to)) {
        continue;
      }
      Vec3 entry;
      SurfacePoint surface;
      const bool hit = marchedEntry(name, from, to, entry);
      const bool reported = shape.query(from, to, 0.0, surface);
      if (!hit) {
        // Marching misses chords shorter than its step, at most 5.2 m / 2000: then the node is hardly past it.
        EXPECT_TRUE(!reported || shape.nearest(from + 0.5 * (to - from)).distance < 0.5) << name;
        continue;
      }
      ++passed;
      ASSERT_TRUE(reported) << name << " " << from.transpose() << " -> " << to.transpose();
      EXPECT_LT(surface.distance, 0.0);
      // Bisection ends at rounding of the fraction (1e-16 of 5.2 m), amplified by grazing: normals of round
      // shapes turn by that over the radius 0.4 m over the cosine of incidence. 1e-9 allows cosines down to 1e-6.
      const SurfacePoint there = shape.nearest(entry);
      if (there.normal.dot((to - from).normalized()) > -1e-3) {
        continue;  // too grazing to tell, or at an edge
      }
      EXPECT_NEAR(surface.distance, surface.normal.dot(to - entry), 1e-9) << name;
      EXPECT_NEAR((surface.normal - there.normal).norm(), 0.0, 1e-9) << name << " " << entry.transpose();
    }
    EXPECT_GT(passed, 50) << name;
  }
}

TEST(Shapes, NodeOnTheSurfaceLeavesFreely) {
  // A start exactly on the surface, outward or along a tangent, is no entry, however it rounds.
  Random random(7);
  for (const auto& [name, shape] : kSolids) {
    for (int k = 0; k < 3000; ++k) {
      const SurfacePoint surface = shape->nearest(random.inBox(1.5));
      const Vec3 point = random.inBox(1.5);
      const SurfacePoint start = shape->nearest(point);
      const Vec3 foot = point - start.distance * start.normal;
      Vec3 direction = surface.normal;
      if (direction.dot(start.normal) < 1e-3) {
        continue;
      }
      SurfacePoint out;
      // All are convex: outward from the tangent plane nothing is crossed.
      EXPECT_FALSE(shape->query(foot, foot + 0.3 * direction, 1e-5, out) && out.distance < -kRounding)
          << name << " " << foot.transpose() << " along " << direction.transpose() << ": " << out.distance;
    }
  }
}

/// Six times the volume that the triangles enclose, and whether every edge has its counterpart.
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
