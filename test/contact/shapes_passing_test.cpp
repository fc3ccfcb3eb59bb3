// SPDX-License-Identifier: BSD-3-Clause
//
// The analytic obstacles give a node back to the side it came from, however deep it got.
#include <gtest/gtest.h>

#include "contact/solids.h"
#include "obstacles/shapes.h"
#include "testing.h"

namespace curtain {
namespace {

using namespace curtain_test;

// Coordinates here are below 4 m: a handful of roundings of 4.4e-16 each stay below this [m].
constexpr double kPassingRounding = 1e-14;

TEST(ShapesPassing, NodePressedIntoAThinPlateGoesBackTheWayItCame) {
  const BoxShape plate(Vec3(1.0, 1.0, 0.01));
  SurfacePoint surface;
  // In the lower half: the nearest exit would be below.
  ASSERT_TRUE(plate.query(Vec3(0.1, 0.2, 0.02), Vec3(0.1, 0.2, -0.004), 0.001, surface));
  EXPECT_EQ(surface.normal, Vec3(Vec3::UnitZ()));
  EXPECT_NEAR(surface.distance, -0.009, kPassingRounding);
  // Right through.
  ASSERT_TRUE(plate.query(Vec3(0.1, 0.2, 0.02), Vec3(0.1, 0.2, -0.5), 0.001, surface));
  EXPECT_EQ(surface.normal, Vec3(Vec3::UnitZ()));
  EXPECT_NEAR(surface.distance, -0.505, kPassingRounding);
  // From below, through.
  ASSERT_TRUE(plate.query(Vec3(0.1, 0.2, -0.02), Vec3(0.1, 0.2, 0.5), 0.001, surface));
  EXPECT_EQ(surface.normal, Vec3(-Vec3::UnitZ()));
  // Who was inside already goes out by the nearest exit.
  ASSERT_TRUE(plate.query(Vec3(0.1, 0.2, -0.003), Vec3(0.1, 0.2, -0.004), 0.001, surface));
  EXPECT_EQ(surface.normal, Vec3(-Vec3::UnitZ()));
  EXPECT_NEAR(surface.distance, -0.001, kPassingRounding);
  // Past the rim nothing is crossed.
  EXPECT_FALSE(plate.query(Vec3(0.51, 0.0, 0.02), Vec3(0.51, 0.0, -0.5), 0.001, surface));
}

TEST(ShapesPassing, NodeThatPassedARoundSolidIsHeldByTheTangentPlaneOfTheEntry) {
  SurfacePoint surface;
  // Sphere: in at (-0.7, 0, 0), out beyond.
  ASSERT_TRUE(kSphere.query(Vec3(-1.0, 0.0, 0.0), Vec3(1.0, 0.1 / 3.0, 0.0), 0.001, surface));
  EXPECT_LT(surface.normal.x(), -0.99);
  EXPECT_LT(surface.distance, -1.6);
  // A thin rod crossed at right angles: entry at x = -0.005, current 0.02 beyond the axis.
  const CapsuleShape rod(0.005, 2.0);
  ASSERT_TRUE(rod.query(Vec3(-0.02, 0.0, 0.3), Vec3(0.02, 0.0, 0.3), 0.0, surface));
  EXPECT_NEAR((surface.normal + Vec3::UnitX()).norm(), 0.0, kPassingRounding);
  EXPECT_NEAR(surface.distance, -0.025, kPassingRounding);
  // Past its axis but still inside: back as well.
  ASSERT_TRUE(rod.query(Vec3(-0.02, 0.0, 0.3), Vec3(0.002, 0.0, 0.3), 0.0, surface));
  EXPECT_NEAR(surface.distance, -0.007, kPassingRounding);
  // Before its axis: the nearest exit is the same side, exact distance.
  ASSERT_TRUE(rod.query(Vec3(-0.02, 0.0, 0.3), Vec3(-0.002, 0.0, 0.3), 0.0, surface));
  EXPECT_NEAR(surface.distance, -0.003, kPassingRounding);
  // Cylinder through its ends.
  ASSERT_TRUE(kCylinder.query(Vec3(0.1, 0.0, 1.0), Vec3(0.1, 0.0, -1.0), 0.0, surface));
  EXPECT_EQ(surface.normal, Vec3(Vec3::UnitZ()));
  EXPECT_NEAR(surface.distance, -1.7, kPassingRounding);
  // Capsule through its caps, along the axis.
  ASSERT_TRUE(kCapsule.query(Vec3(0.0, 0.0, 2.0), Vec3(0.0, 0.0, -2.0), 0.0, surface));
  EXPECT_NEAR((surface.normal - Vec3::UnitZ()).norm(), 0.0, kPassingRounding);
  EXPECT_NEAR(surface.distance, -3.0, kPassingRounding);
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

TEST(ShapesPassing, EntryAgreesWithMarchingAlongTheWay) {
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

TEST(ShapesPassing, NodeOnTheSurfaceLeavesFreely) {
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
      EXPECT_FALSE(shape->query(foot, foot + 0.3 * direction, 1e-5, out) && out.distance < -kPassingRounding)
          << name << " " << foot.transpose() << " along " << direction.transpose() << ": " << out.distance;
    }
  }
}

/// Six times the volume that the triangles enclose, and whether every edge has its counterpart.
}  // namespace
}  // namespace curtain
