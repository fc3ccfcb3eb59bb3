// SPDX-License-Identifier: BSD-3-Clause
//
// A ray meets a solid where the distance to its surface is zero for the first time, and with the normal there.
#include "sensing/solid_rays.h"

#include <gtest/gtest.h>

#include "sensing/brute_rays.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::Random;

ObstacleParams solid(ShapeKind shape) {
  ObstacleParams obstacle;
  obstacle.shape = shape;
  obstacle.radius = 0.4;
  obstacle.length = 1.1;
  obstacle.size = Vec3(1.0, 1.6, 0.6);
  return obstacle;
}

class SolidRays : public ::testing::TestWithParam<ShapeKind> {};

TEST_P(SolidRays, MeetTheSurface) {
  const ObstacleParams params = solid(GetParam());
  const auto shape = makeObstacleShape(params);
  Random random(3);
  const auto distance = [&](const Vec3& point) {
    SurfacePoint surface;
    EXPECT_TRUE(shape->query(point, point, 100.0, surface));
    return surface.distance;
  };
  int met = 0, missed = 0;
  for (int n = 0; n < 20000; ++n) {
    Vec3 origin = random.inBox(2.0);
    while (distance(origin) < 0.01) origin = random.inBox(2.0);
    const double speed = random.between(0.1, 3.0);
    const Vec3 direction = speed * (random.inBox(0.5) - origin).normalized();
    const auto hit = firstHit(params, origin, direction, 0.0);
    constexpr double kFar = 50.0;  // [m] that the steps go
    const double truth = curtain_test::meetSolid(*shape, origin, direction.normalized(), 0.0, kFar);
    if (hit && hit->distance * speed > kFar) continue;  // of the plane alone
    if (!hit) {
      EXPECT_TRUE(std::isinf(truth)) << "one comes within 1e-9 m of it";
      ++missed;
      continue;
    }
    ++met;
    // On a grazing ray to a radius of up to 0.5 m, 1e-9 m above the surface are sqrt(2 0.5 1e-9) m before it.
    EXPECT_NEAR(hit->distance * speed, truth, 1e-4);
    const Vec3 point = origin + hit->distance * direction;
    EXPECT_NEAR(distance(point), 0.0, 1e-12);
    SurfacePoint surface;
    const Vec3 outside = point + 1e-3 * hit->normal;
    ASSERT_TRUE(shape->query(outside, outside, 1.0, surface));
    EXPECT_NEAR(surface.distance, 1e-3, 1e-12) << "straight out";
    if (::testing::Test::HasFailure()) return;
  }
  EXPECT_GT(met, 4000);
  EXPECT_GT(missed, GetParam() == ShapeKind::kSphere ? 300 : 0);
}

TEST_P(SolidRays, FromInsideMeetTheFarSide) {
  const ObstacleParams params = solid(GetParam());
  const auto shape = makeObstacleShape(params);
  Random random(4);
  for (int n = 0; n < 1000; ++n) {
    const Vec3 origin = random.inBox(0.2) - 0.25 * Vec3::UnitZ() * (GetParam() == ShapeKind::kPlane);
    const Vec3 direction = random.direction();
    const auto hit = firstHit(params, origin, direction, 0.0);
    if (GetParam() == ShapeKind::kPlane && direction.z() <= 0.0) {
      EXPECT_FALSE(hit) << "there is no other side";
      continue;
    }
    ASSERT_TRUE(hit);
    const Vec3 point = origin + hit->distance * direction;
    SurfacePoint surface;
    ASSERT_TRUE(shape->query(point, point, 1.0, surface));
    EXPECT_NEAR(surface.distance, 0.0, 1e-12 * (1.0 + point.norm()));
    EXPECT_GT(hit->normal.dot(direction), 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(All, SolidRays,
                         ::testing::Values(ShapeKind::kSphere, ShapeKind::kBox, ShapeKind::kCylinder,
                                           ShapeKind::kCapsule, ShapeKind::kPlane));

}  // namespace
}  // namespace curtain
