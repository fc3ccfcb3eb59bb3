// SPDX-License-Identifier: BSD-3-Clause
//
// Distances of triangles from the analytic obstacles against those of the Flexible Collision Library, which finds them
// by GJK with libccd: an answer that none of our code has a part in.
#include <fcl/fcl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <string>

#include "obstacles/shapes.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::Random;
using Triangle = std::array<Vec3, 3>;

struct Solid {
  std::string name;
  std::unique_ptr<ConvexShape> ours;
  std::shared_ptr<fcl::CollisionGeometryd> theirs;
};

std::vector<Solid> solids() {
  std::vector<Solid> all;
  all.push_back({"sphere", std::make_unique<SphereShape>(0.7), std::make_shared<fcl::Sphered>(0.7)});
  all.push_back({"box", std::make_unique<BoxShape>(Vec3(1.0, 1.6, 0.6)), std::make_shared<fcl::Boxd>(1.0, 1.6, 0.6)});
  all.push_back({"cylinder", std::make_unique<CylinderShape>(0.5, 1.4), std::make_shared<fcl::Cylinderd>(0.5, 1.4)});
  all.push_back({"capsule", std::make_unique<CapsuleShape>(0.4, 1.2), std::make_shared<fcl::Capsuled>(0.4, 1.2)});
  return all;
}

double longestEdge(const Triangle& corners) {
  return std::max(
      {(corners[1] - corners[0]).norm(), (corners[2] - corners[1]).norm(), (corners[0] - corners[2]).norm()});
}

// Not above zero where they overlap.
double theirDistance(const Solid& solid, const Triangle& corners) {
  const auto triangle = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  triangle->beginModel();
  triangle->addTriangle(corners[0], corners[1], corners[2]);
  triangle->endModel();
  const fcl::CollisionObjectd one(triangle, fcl::Transform3d::Identity()),
      other(solid.theirs, fcl::Transform3d::Identity());
  fcl::DistanceRequestd request;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  request.distance_tolerance = 1e-9;
  fcl::DistanceResultd result;
  return fcl::distance(&one, &other, request, result);
}

// Of coordinates near 1 in double precision, many times.
constexpr double kRounding = 1e-12;

TEST(FclOracle, TrianglesAreAsFarFromSolids) {
  for (const Solid& solid : solids()) {
    Random random(3);
    int outside = 0, inside = 0;
    for (int round = 0; round < 3000; ++round) {
      const Vec3 middle = random.inBox(1.2);
      const double size = round % 2 == 0 ? 0.05 : 1.0;
      const Triangle corners{Vec3(middle + random.inBox(size)), Vec3(middle + random.inBox(size)),
                             Vec3(middle + random.inBox(size))};
      const double theirs = theirDistance(solid, corners);
      ElementPoint ours;
      ASSERT_TRUE(solid.ours->nearestOnTriangle(corners, std::numeric_limits<double>::infinity(), ours));
      if (theirs > 0.0) {
        // GJK ends with two points that are so far apart: the truth is no further, and ours is no more above it than it
        // says.
        EXPECT_LE(ours.lower_bound, theirs + kRounding) << solid.name << ", round " << round;
        EXPECT_LE(ours.surface.distance, theirs + kElementAccuracy * longestEdge(corners))
            << solid.name << ", round " << round;
        ++outside;
      } else {
        EXPECT_LE(ours.surface.distance, kElementAccuracy * longestEdge(corners)) << solid.name << ", round " << round;
        ++inside;
      }
    }
    EXPECT_GT(outside, 1000) << solid.name;
    EXPECT_GT(inside, 300) << solid.name;
  }
}

}  // namespace
}  // namespace curtain
