// SPDX-License-Identifier: BSD-3-Clause
//
// Closest points of a point and a triangle and of two segments, against distances found in other ways.
#include "contact/narrow_phase/closest_points.h"

#include <gtest/gtest.h>

#include "contact/ccd_oracle.h"
#include "testing.h"

namespace {

using curtain::closestOnSegments;
using curtain::closestOnTriangle;
using curtain::Vec3;
using curtain_test::distanceOfSegments;
using curtain_test::distanceToTriangle;
using curtain_test::Random;
using curtain_test::Real;
using curtain_test::Vec3l;

Vec3l exact(const Vec3& v) { return v.cast<Real>(); }

/// The weights make the distance, and that is the least, both within `rounding` [m].
void expectTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, double rounding) {
  const auto closest = closestOnTriangle(p, a, b, c);
  ASSERT_GE(closest.weights.minCoeff(), 0.0);
  ASSERT_NEAR(closest.weights.sum(), 1.0, 1e-15);
  const Vec3 on = closest.weights[0] * a + closest.weights[1] * b + closest.weights[2] * c;
  const double least = static_cast<double>(distanceToTriangle(exact(p), exact(a), exact(b), exact(c)));
  ASSERT_NEAR((p - on).norm(), least, rounding);
  ASSERT_NEAR(std::sqrt(closest.distance_squared), least, rounding);
}

void expectSegments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double rounding) {
  const auto closest = closestOnSegments(a, b, c, d);
  ASSERT_GE(std::min(closest.s, closest.t), 0.0);
  ASSERT_LE(std::max(closest.s, closest.t), 1.0);
  const Vec3 between = a + closest.s * (b - a) - c - closest.t * (d - c);
  const double least = static_cast<double>(distanceOfSegments(exact(a), exact(b), exact(c), exact(d)));
  ASSERT_NEAR(between.norm(), least, rounding);
  ASSERT_NEAR(std::sqrt(closest.distance_squared), least, rounding);
}

TEST(ClosestOnTriangle, HoldsForRandomOnes) {
  Random random(1);
  for (int k = 0; k < 50000; ++k) {
    const Vec3 a = random.inBox(1.0), b = random.inBox(1.0), c = random.inBox(1.0);
    expectTriangle(random.inBox(2.0), a, b, c, 1e-14);
    const double u = random.between(0.0, 1.0);
    expectTriangle(a + u * (b - a) + random.between(0.0, 1.0 - u) * (c - a), a, b, c, 1e-13);  // on the triangle
    if (HasFatalFailure()) return;
  }
}

// Heights from a tenth of the base down to nothing.
TEST(ClosestOnTriangle, HoldsForSlivers) {
  Random random(2);
  for (int k = 0; k < 10000; ++k) {
    const Vec3 a = random.inBox(1.0), b = random.inBox(1.0);
    const double height = std::pow(10.0, -1 - k % 20);
    const Vec3 c = a + random.between(-0.5, 1.5) * (b - a) + height * random.direction();
    expectTriangle(random.inBox(2.0), a, b, c, 1e-10);
    expectTriangle(a + random.between(-0.5, 1.5) * (b - a) + height * random.direction(), a, b, c, 1e-10);
    if (HasFatalFailure()) FAIL() << "height " << height;
  }
}

TEST(ClosestOnTriangle, HoldsForPointsAndLines) {
  const Vec3 o(0, 0, 0), x(1, 0, 0), p(0.25, 3, 4);
  expectTriangle(p, o, o, o, 1e-15);
  expectTriangle(p, o, x, o, 1e-15);
  expectTriangle(p, o, o, x, 1e-15);
  expectTriangle(p, x, o, o, 1e-15);
  expectTriangle(p, o, x, 2.0 * x, 1e-15);
  expectTriangle(p, 2.0 * x, o, x, 1e-15);
  expectTriangle(x, o, x, x, 1e-15);
}

TEST(ClosestOnSegments, HoldsForRandomOnes) {
  Random random(3);
  for (int k = 0; k < 50000; ++k) {
    expectSegments(random.inBox(1.0), random.inBox(1.0), random.inBox(1.0), random.inBox(1.0), 1e-14);
    if (HasFatalFailure()) return;
  }
}

// Angles from a tenth down to nothing.
TEST(ClosestOnSegments, HoldsForNearlyParallelOnes) {
  Random random(4);
  for (int k = 0; k < 10000; ++k) {
    const double angle = std::pow(10.0, -1 - k % 20);
    const Vec3 a = random.inBox(1.0), b = random.inBox(1.0);
    const Vec3 c = a + random.between(-1.0, 1.0) * (b - a) + angle * random.direction();
    const Vec3 d = c + random.between(-2.0, 2.0) * (b - a) + angle * random.direction();
    const Vec3 aside = k % 3 == 0 ? random.inBox(0.5) : Vec3(0, 0, 0);
    expectSegments(a, b, c + aside, d + aside, 1e-13);
    if (HasFatalFailure()) FAIL() << "angle " << angle;
  }
}

TEST(ClosestOnSegments, HoldsForPointsAndLines) {
  const Vec3 o(0, 0, 0), x(1, 0, 0), y(0, 1, 0);
  expectSegments(o, o, x, x, 1e-15);
  expectSegments(o, o, x, x + y, 1e-15);
  expectSegments(x, x + y, o, o, 1e-15);
  expectSegments(o, x, o, x, 1e-15);
  expectSegments(o, x, 2.0 * x, 3.0 * x, 1e-15);
  expectSegments(o, x, 3.0 * x, 2.0 * x, 1e-15);
  expectSegments(o, x, y + 0.5 * x, y + 2.0 * x, 1e-15);
  expectSegments(o, 2.0 * x, x - y, x + y, 1e-15);
}

}  // namespace
