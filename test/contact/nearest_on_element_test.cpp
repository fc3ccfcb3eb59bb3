// SPDX-License-Identifier: BSD-3-Clause
//
// Edges and triangles against the analytic obstacles: the nearest (deepest) point, its certified lower bound, and when
// a moving element first comes near, all against dense sampling of distances that shapes_test.cpp has checked.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "contact/solids.h"
#include "scene/infinity.h"
#include "testing.h"

namespace curtain {
namespace {

using namespace curtain_test;
using Triangle = std::array<Vec3, 3>;
using Edge = std::array<Vec3, 2>;

template <std::size_t N>
Vec3 pointAt(const std::array<Vec3, N>& corners, const std::array<double, 3>& weights) {
  Vec3 point = Vec3::Zero();
  for (std::size_t k = 0; k < N; ++k) point += weights[k] * corners[k];
  return point;
}

template <std::size_t N>
double longestEdge(const std::array<Vec3, N>& corners) {
  double longest = 0.0;
  for (std::size_t k = 0; k < N; ++k) longest = std::max(longest, (corners[(k + 1) % N] - corners[k]).norm());
  return longest;
}

bool nearestOn(const ConvexShape& shape, const Triangle& corners, double reach, ElementPoint& out) {
  return shape.nearestOnTriangle(corners, reach, out);
}
bool nearestOn(const ConvexShape& shape, const Edge& ends, double reach, ElementPoint& out) {
  return shape.nearestOnEdge(ends, reach, out);
}

/// Calls f(weights) for points a step of 1/n apart all over the element.
template <std::size_t N, typename F>
void forEachSample(int n, F&& f) {
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= (N == 3 ? n - i : 0); ++j) {
      const double s = static_cast<double>(i) / n;
      const double t = static_cast<double>(j) / n;
      f(std::array<double, 3>{1.0 - s - t, s, t});
    }
  }
}

/// Everything a nearest point promises. The bound is below every sample and the point within the accuracy of the bound:
/// so it is the nearest one.
template <std::size_t N>
void checkNearest(const std::string& name, const ConvexShape& shape, const std::array<Vec3, N>& corners, int n) {
  ElementPoint nearest;
  ASSERT_TRUE(nearestOn(shape, corners, kInfinity, nearest)) << name;
  double sum = 0.0;
  for (const double weight : nearest.weights) {
    EXPECT_GE(weight, 0.0) << name;
    sum += weight;
  }
  double size = 4.0;  // of the shapes and their places [m]
  for (const Vec3& corner : corners) size = std::max(size, corner.norm());
  const double rounding = 64.0 * curtain_test::kEps * size;
  EXPECT_NEAR(sum, 1.0, 8.0 * curtain_test::kEps) << name;
  const SurfacePoint there = shape.nearest(pointAt(corners, nearest.weights));
  EXPECT_NEAR(there.distance, nearest.surface.distance, rounding) << name;
  EXPECT_NEAR(nearest.surface.normal.norm(), 1.0, 1e-14) << name;
  EXPECT_LE(nearest.surface.distance, nearest.lower_bound + kElementAccuracy * longestEdge(corners) + rounding) << name;
  forEachSample<N>(n, [&](const std::array<double, 3>& weights) {
    EXPECT_GE(shape.nearest(pointAt(corners, weights)).distance, nearest.lower_bound) << name;
  });
}

template <std::size_t N>
std::array<Vec3, N> randomElement(Random& random, double spread, double size) {
  std::array<Vec3, N> corners;
  const Vec3 centre = random.inBox(spread);
  for (Vec3& corner : corners) corner = centre + random.inBox(size);
  return corners;
}

template <std::size_t N>
void checkRandomElements(std::uint64_t seed) {
  Random random(seed);
  for (const auto& [name, shape] : kSolids) {
    for (const double size : {0.02, 0.3, 1.0, 5.0, 40.0}) {  // inside, near, through, around
      for (int n = 0; n < 300 && !::testing::Test::HasFailure(); ++n) {
        checkNearest(name, *shape, randomElement<N>(random, 1.2, size), 12);
      }
    }
    for (int n = 0; n < 100; ++n) checkNearest(name, *shape, randomElement<N>(random, 100.0, 1.0), 6);
  }
}

TEST(NearestOnElement, IsTheSmallestDistanceOfTriangles) { checkRandomElements<3>(1); }
TEST(NearestOnElement, IsTheSmallestDistanceOfEdges) { checkRandomElements<2>(2); }

// Elements in the planes and along the axes of the shapes: ties, parallels, kinks of the distance.
TEST(NearestOnElement, HoldsOnALattice) {
  Random random(3);
  const double lattice[] = {-1.0, -0.8, -0.7, -0.6, -0.5, -0.3, 0.0, 0.3, 0.5, 0.6, 0.7, 0.8, 1.0};
  const auto coordinate = [&] { return lattice[static_cast<std::size_t>(random.between(0.0, 13.0))]; };
  for (const auto& [name, shape] : kSolids) {
    for (int n = 0; n < 2000 && !HasFailure(); ++n) {
      Triangle corners;
      for (Vec3& corner : corners) {
        const double x = coordinate();
        const double y = coordinate();
        corner = Vec3(x, y, coordinate());
      }
      checkNearest(name, *shape, corners, 10);
      checkNearest(name, *shape, Edge{corners[0], corners[1]}, 20);
    }
  }
}

// What is as deep on one side of a middle as on the other leaves on the side that most of the element is on, not on
// that of larger coordinates: the image of an element in a mirror leaves as the image, to the bit (a capsule is gone
// through from one end: across z but for rounding). Elements whose own middle is in the mirror have no such side.
template <std::size_t N>
void checkMirrored(const std::string& name, const ConvexShape& shape, const std::array<Vec3, N>& corners, int axis) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& corner : corners) middle += corner / static_cast<double>(N);
  if (std::abs(middle[axis]) < 1e-12 || (axis == 2 && (name == "plane" || name == "capsule"))) return;
  std::array<Vec3, N> image = corners;
  for (Vec3& corner : image) corner[axis] = -corner[axis];
  ElementPoint nearest, of_image;
  ASSERT_TRUE(nearestOn(shape, corners, kInfinity, nearest));
  ASSERT_TRUE(nearestOn(shape, image, kInfinity, of_image));
  of_image.surface.normal[axis] = -of_image.surface.normal[axis];
  EXPECT_EQ(of_image.weights, nearest.weights) << name;
  EXPECT_EQ(of_image.surface.distance, nearest.surface.distance) << name;
  EXPECT_EQ(of_image.surface.normal, nearest.surface.normal) << name << " across " << axis;
  EXPECT_EQ(of_image.lower_bound, nearest.lower_bound) << name;
}

TEST(NearestOnElement, OfAnImageIsTheImage) {
  Random random(4);
  const double lattice[] = {-0.5, -0.3, -0.1, 0.0, 0.1, 0.3, 0.5};
  const auto coordinate = [&] { return lattice[static_cast<std::size_t>(random.between(0.0, 7.0))]; };
  for (const auto& [name, shape] : kSolids) {
    for (int n = 0; n < 1000 && !HasFailure(); ++n) {
      Triangle corners;
      for (Vec3& corner : corners) {
        const double x = coordinate();
        const double y = coordinate();
        corner = Vec3(x, y, coordinate());
      }
      for (int axis = 0; axis < 3; ++axis) {
        checkMirrored(name, *shape, corners, axis);
        checkMirrored(name, *shape, Edge{corners[0], corners[1]}, axis);
        checkMirrored(name, *shape, randomElement<3>(random, 0.2, 0.5), axis);
      }
    }
  }
}

TEST(NearestOnElement, HoldsForElementsWithoutAreaOrLength) {
  Random random(4);
  for (const auto& [name, shape] : kSolids) {
    for (int n = 0; n < 1000 && !HasFailure(); ++n) {
      const Vec3 a = random.inBox(1.5);
      const Vec3 b = random.inBox(1.5);
      const double t = random.between(-0.5, 1.5);
      const Vec3 on = a + t * (b - a);
      const Vec3 beside = on + std::pow(10.0, random.between(-17.0, -6.0)) * random.inBox(1.0);
      for (const Triangle& corners :
           {Triangle{a, a, a}, Triangle{a, b, a}, Triangle{a, b, on}, Triangle{on, b, a}, Triangle{a, beside, b},
            Triangle{a, a + 1e-200 * b, a + 1e-200 * on}, Triangle{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}}) {
        checkNearest(name, *shape, corners, 20);
      }
      checkNearest(name, *shape, Edge{a, a}, 1);
    }
  }
}

TEST(NearestOnElement, HoldsAtEveryScale) {
  for (const double scale : {1e-120, 1e-9, 1e6, 1e120}) {
    const SphereShape sphere(0.7 * scale);
    const BoxShape box(scale * Vec3(1.0, 1.6, 0.6));
    const CylinderShape cylinder(0.5 * scale, 1.4 * scale);
    const CapsuleShape capsule(0.4 * scale, 1.2 * scale);
    const std::map<std::string, const ConvexShape*> solids = {
        {"sphere", &sphere}, {"box", &box}, {"cylinder", &cylinder}, {"capsule", &capsule}, {"plane", &kPlane}};
    for (const auto& [name, shape] : solids) {
      Random random(5);
      for (int n = 0; n < 200; ++n) {
        Triangle corners = randomElement<3>(random, 1.0, 0.7);
        ElementPoint expected;
        ASSERT_TRUE(kSolids.at(name)->nearestOnTriangle(corners, kInfinity, expected));
        for (Vec3& corner : corners) corner *= scale;
        ElementPoint scaled;
        ASSERT_TRUE(shape->nearestOnTriangle(corners, kInfinity, scaled));
        EXPECT_NEAR(scaled.surface.distance / scale, expected.surface.distance, 4e-7) << name << " x " << scale;
      }
    }
  }
}

TEST(NearestOnElement, SaysNothingOnlyBeyondReach) {
  Random random(6);
  int within = 0;
  int beyond = 0;
  for (const auto& [name, shape] : kSolids) {
    for (int n = 0; n < 1000; ++n) {
      const Triangle corners = randomElement<3>(random, 1.5, 0.4);
      const double reach = random.between(-0.2, 0.5);
      ElementPoint whole;
      ElementPoint limited;
      ASSERT_TRUE(shape->nearestOnTriangle(corners, kInfinity, whole));
      const bool found = shape->nearestOnTriangle(corners, reach, limited);
      (found ? within : beyond) += 1;
      if (found) {
        EXPECT_NEAR(limited.surface.distance, whole.surface.distance, 2e-7) << name;
        EXPECT_LE(whole.lower_bound, reach + 2e-7) << name;
      } else {
        EXPECT_GT(whole.surface.distance, reach) << name;
      }
    }
  }
  EXPECT_GT(within, 1000);
  EXPECT_GT(beyond, 1000);
}

template <std::size_t N>
std::array<Vec3, N> between(const std::array<Vec3, N>& start, const std::array<Vec3, N>& end, double t) {
  std::array<Vec3, N> corners;
  for (std::size_t k = 0; k < N; ++k) corners[k] = start[k] + t * (end[k] - start[k]);
  return corners;
}

/// The time of impact is not after the first sample that is nearer, and at that time the element is all but there,
/// unless it turns past at a hair's breadth: those are counted as early.
template <std::size_t N>
void checkImpact(const std::string& name, const ConvexShape& shape, const std::array<Vec3, N>& start,
                 const std::array<Vec3, N>& end, double min_distance, int& impacts, int& early) {
  const std::optional<double> time = shape.timeOfImpact(start, end, min_distance);
  const double until = time.value_or(1.0);
  ASSERT_GE(until, 0.0) << name;
  ASSERT_LE(until, 1.0) << name;
  ElementPoint nearest;
  constexpr int kSamples = 100;
  for (int n = 0; n < kSamples; ++n) {
    nearestOn(shape, between(start, end, until * n / kSamples), kInfinity, nearest);
    EXPECT_GT(nearest.surface.distance, min_distance) << name << " at " << until * n / kSamples << " of " << until;
    if (until == 0.0) return;
  }
  nearestOn(shape, between(start, end, until), kInfinity, nearest);
  if (!time) {
    EXPECT_GT(nearest.surface.distance, min_distance) << name;
    return;
  }
  ++impacts;
  early += nearest.surface.distance > min_distance + 1e-5;
  EXPECT_LE(nearest.surface.distance, min_distance + 1e-3) << name << " too early, at " << *time;
}

template <std::size_t N>
void checkRandomImpacts(std::uint64_t seed) {
  Random random(seed);
  for (const auto& [name, shape] : kSolids) {
    int impacts = 0;
    int starts = 0;
    int early = 0;
    for (int n = 0; n < 1500; ++n) {
      const double size = n % 3 == 0 ? 0.05 : 0.6;
      const auto start = randomElement<N>(random, 2.0, size);
      std::array<Vec3, N> end = randomElement<N>(random, 2.0, size);
      if (n % 5 == 0) end = between(start, end, 0.01);
      const double min_distance = n % 2 == 0 ? 0.004 : 0.0;
      ElementPoint nearest;
      nearestOn(*shape, start, kInfinity, nearest);
      if (nearest.surface.distance <= min_distance) {
        EXPECT_EQ(shape->timeOfImpact(start, end, min_distance), std::optional<double>(0.0)) << name;
        ++starts;
        continue;
      }
      checkImpact(name, *shape, start, end, min_distance, impacts, early);
    }
    EXPECT_GT(impacts, 50) << name;
    EXPECT_GT(starts, 20) << name;
    EXPECT_LE(200 * early, impacts) << name;
  }
}

TEST(TimeOfImpact, IsNeverLateForTriangles) { checkRandomImpacts<3>(7); }
TEST(TimeOfImpact, IsNeverLateForEdges) { checkRandomImpacts<2>(8); }

// No corner comes near; nor does the element at the ends of the step.
TEST(TimeOfImpact, SeesWhatSlipsBetweenTheCorners) {
  const SphereShape pea(0.01);
  const Triangle start{Vec3(-1.0, -1.0, 1.0), Vec3(1.0, -1.0, 1.0), Vec3(0.0, 1.0, 1.0)};
  Triangle end = start;
  for (Vec3& corner : end) corner.z() = -3.0;
  const std::optional<double> time = pea.timeOfImpact(start, end, 0.0);
  ASSERT_TRUE(time.has_value());
  EXPECT_NEAR(*time, 0.99 / 4.0, 1e-6);
  const Triangle aside = between(start, end, 0.0);
  Triangle aside_end = end;
  for (Vec3& corner : aside_end) corner.x() += 40.0;
  EXPECT_FALSE(pea.timeOfImpact(aside, aside_end, 0.0).has_value());
}

// A triangle that slides along a face, or leaves it, touches nothing.
TEST(TimeOfImpact, IsNoneForWhatSlidesPast) {
  const Triangle start{Vec3(-0.3, 0.0, 0.31), Vec3(0.3, 0.1, 0.31), Vec3(0.0, 0.4, 0.31)};
  Triangle end = start;
  for (Vec3& corner : end) corner += Vec3(5.0, 3.0, 0.0);
  EXPECT_FALSE(kBox.timeOfImpact(start, end, 0.009).has_value());
  for (Vec3& corner : end) corner.z() += 2.0;
  EXPECT_FALSE(kBox.timeOfImpact(start, end, 0.009).has_value());
}

}  // namespace
}  // namespace curtain
