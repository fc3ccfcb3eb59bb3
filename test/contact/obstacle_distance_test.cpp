// SPDX-License-Identifier: BSD-3-Clause
//
// Where the cloth is nearest to an obstacle, against dense sampling of the cloth: no sample may be nearer, and the
// nearest sample is no further than samples are apart.
#include "contact/oracle/obstacle_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "bumpy_sphere.h"
#include "cloth/coarse_mesh.h"
#include "obstacles/triangle_mesh.h"
#include "solids.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::Random;

constexpr int kSamples = 24;  // along the edge of a triangle
constexpr double kDistanceRounding = 1e-6;

// Crumpled cloth somewhere around the origin.
Field3 crumpled(const Grid& grid, Random& random, double apart) {
  Field3 position;
  position.assign(grid.size(), 1e9);  // padding: far from everything
  const Vec3 along = 0.3 * random.direction(), across = along.cross(random.direction());
  const Vec3 first = apart * random.direction();
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j)
      position.set(grid.index(i, j), first + i * along + j * across + random.inBox(0.05));
  }
  return position;
}

struct Sampled {
  double distance = std::numeric_limits<double>::infinity();
  double spacing = 0.0;  // no point of the cloth is further from a sample [m]
};

Sampled sample(const ContactShape& shape, const Transform& place, const Grid& grid, const Field3& position) {
  Sampled result;
  for (const MeshTriangle& triangle : makeCoarseMesh(grid).triangles) {
    const Vec3 a = position.at(triangle[0]), u = position.at(triangle[1]) - a, v = position.at(triangle[2]) - a;
    result.spacing = std::max(result.spacing, std::max({u.norm(), v.norm(), (u - v).norm()}) / kSamples);
    for (int k = 0; k <= kSamples; ++k) {
      for (int l = 0; k + l <= kSamples; ++l) {
        const Vec3 p = place.toLocal(a + (u * k + v * l) / kSamples);
        SurfacePoint surface;
        if (shape.query(p, p, 1e3, surface)) result.distance = std::min(result.distance, surface.distance);
      }
    }
  }
  return result;
}

// Of 40 random sheets around it.
void compare(const ContactShape& shape, const std::string& name, std::uint64_t first_seed) {
  int apart = 0;
  for (std::uint64_t seed = first_seed; seed < first_seed + 40; ++seed) {
    SCOPED_TRACE(name + ", seed " + std::to_string(seed));
    Random random(seed);
    const Grid grid(4, 5, seed % 3 == 0);
    const Field3 position = crumpled(grid, random, random.between(0.5, 4.0));
    const Pose pose{random.inBox(0.5),
                    Eigen::Quaterniond(Eigen::AngleAxisd(random.between(0.0, 3.0), random.direction()))};
    const Transform place(pose);
    const Sampled sampled = sample(shape, place, grid, position);
    const ObstacleDistance found = distanceTo(shape, place, grid, position);
    EXPECT_NEAR((found.on_cloth - found.on_obstacle).norm(), std::abs(found.distance), kDistanceRounding);
    SurfacePoint surface;
    const Vec3 touch = place.toLocal(found.on_obstacle);
    ASSERT_TRUE(shape.query(touch, touch, 1e3, surface));
    EXPECT_NEAR(surface.distance, 0.0, kDistanceRounding) << "it is on the surface";
    if (shape.convex() == nullptr && sampled.distance < sampled.spacing) continue;  // it may go through the mesh
    EXPECT_LE(found.distance, sampled.distance + kDistanceRounding);
    EXPECT_GE(found.distance, sampled.distance - sampled.spacing);
    apart += found.distance > 0.0;
  }
  EXPECT_GT(apart, 5) << name;
}

TEST(ObstacleDistance, IsThatOfDenseSamplesOfTheCloth) {
  for (const auto& [name, solid] : curtain_test::kSolids) compare(*solid, name, 100);
  compare(TriangleMeshShape(curtain_test::kBox.triangles()), "mesh of a box", 200);
  compare(TriangleMeshShape(curtain_test::bumpySphere(12, 14, 0.3)), "bumpy mesh", 300);
}

// One large quad in a plane, above everything.
Field3 plate(const Grid& grid, double height) {
  Field3 position;
  position.assign(grid.size(), 1e9);
  for (int k = 0; k < 4; ++k)
    position.set(grid.index(k / 2, k % 2), Vec3(k % 2 == 0 ? -5.0 : 4.0, k / 2 == 0 ? -5.0 : 4.0, height));
  return position;
}

TEST(ObstacleDistance, IsOfAFaceOverACorner) {
  const Grid grid(2, 2, false);
  const TriangleMeshShape box(curtain_test::kBox.triangles());
  const Vec3 corner(0.5, 0.8, 0.3);
  Pose pose;
  pose.orientation = Eigen::Quaterniond::FromTwoVectors(corner, Vec3::UnitZ());
  const ObstacleDistance found = distanceTo(box, Transform(pose), grid, plate(grid, 2.0));
  EXPECT_NEAR(found.distance, 2.0 - corner.norm(), 1e-12);
  EXPECT_LT((found.on_obstacle - Vec3(0.0, 0.0, corner.norm())).norm(), 1e-12);
  EXPECT_LT((found.on_cloth - Vec3(0.0, 0.0, 2.0)).norm(), 1e-12);
}

TEST(ObstacleDistance, IsOfAnEdgeBetweenItsNodes) {
  const Grid grid(2, 2, false);
  Field3 position;
  position.assign(grid.size(), 1e9);
  for (int k = 0; k < 4; ++k) position.set(grid.index(k / 2, k % 2), Vec3(k % 2 == 0 ? -5.0 : 5.0, 2.0 + k / 2, 0.0));
  const ObstacleDistance found =
      distanceTo(TriangleMeshShape(curtain_test::kBox.triangles()), Transform(), grid, position);
  EXPECT_NEAR(found.distance, 2.0 - 0.8, 1e-12);
  EXPECT_NEAR(found.on_cloth.y(), 2.0, 1e-12);
  EXPECT_LE(std::abs(found.on_cloth.x()), 0.5 + 1e-12);
  EXPECT_NEAR(found.on_obstacle.y(), 0.8, 1e-12);
}

}  // namespace
}  // namespace curtain
