// SPDX-License-Identifier: BSD-3-Clause
//
// Patches of triangles and their clearance from obstacles, against dense samples of the patch.
#include "contact/narrow_phase/element_clearance.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "obstacles/shapes.h"
#include "obstacles/triangle_mesh.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::Random;

constexpr int kSamples = 40;  // along a side

/// Least distance of the samples; a sample lies within the longest side / kSamples of every point.
double sampledDistance(const ContactShape& shape, const Transform& place, const std::vector<Vec3>& points,
                       const MeshTriangle& triangle) {
  double least = 10.0;
  const Vec3 a = points[triangle[0]], b = points[triangle[1]], c = points[triangle[2]];
  for (int i = 0; i <= kSamples; ++i) {
    for (int j = 0; i + j <= kSamples; ++j) {
      const Vec3 local = place.toLocal(a + (b - a) * i / kSamples + (c - a) * j / kSamples);
      SurfacePoint surface;
      if (shape.query(local, local, least, surface)) least = std::min(least, surface.distance);
    }
  }
  return least;
}

TEST(ElementClearance, AgreesWithSamples) {
  const SphereShape sphere(0.5);
  const BoxShape box(Vec3(0.6, 1.0, 0.4));
  const CylinderShape cylinder(0.3, 0.8);
  const CapsuleShape capsule(0.3, 0.6);
  const PlaneShape plane;
  const TriangleMeshShape mesh(cylinder.triangles());
  const std::map<std::string, const ContactShape*> shapes = {{"sphere", &sphere},     {"box", &box},
                                                             {"cylinder", &cylinder}, {"capsule", &capsule},
                                                             {"plane", &plane},       {"mesh", &mesh}};
  Random random(3);
  ElementClearance clearance;
  for (const auto& [name, shape] : shapes) {
    int kept = 0, close = 0;
    for (int n = 0; n < 400; ++n) {
      Pose pose;
      pose.position = random.inBox(2.0);
      pose.orientation = Eigen::AngleAxisd(random.between(0.0, 3.0), random.direction());
      const Transform place(pose);
      const Vec3 centre = random.inBox(1.0);
      std::vector<Vec3> points;
      for (int p = 0; p < 4; ++p) points.push_back(place.toWorld(centre + random.inBox(0.3)));
      const std::vector<MeshTriangle> patch = {{0, 1, 2}, {1, 3, 3}};  // a triangle and a rod
      const double wanted = random.between(0.0, 0.3);
      double sampled =
          std::min(sampledDistance(*shape, place, points, patch[0]), sampledDistance(*shape, place, points, patch[1]));
      // Of a mesh only the surface counts: patches that reach inside without crossing it are the caller's to know.
      const bool keeps = clearance.keeps(*shape, place, points, patch, wanted);
      if (shape == &mesh && keeps && sampled < -0.05) continue;
      const double spacing = 1.05 / kSamples;
      EXPECT_GE(sampled, keeps ? wanted - 1e-6 : -10.0) << name;
      EXPECT_LE(sampled, keeps ? 10.0 : wanted + spacing) << name;
      kept += keeps;
      close += !keeps && sampled > 0.0;
    }
    EXPECT_GT(kept, 40) << name;
    EXPECT_GT(close, 20) << name;
  }
}

// A shell counts where it is crossed, even by a blade that none of the patch's edges or corners comes near to.
TEST(ElementClearance, SeesABladeThroughATriangle) {
  ShapeTriangles blade;
  blade.corners = {{0.2, 0.2, 0.5}, {0.15, 0.2, -1.0}, {0.25, 0.2, -1.0}};
  blade.triangles = {{0, 1, 2}};
  const TriangleMeshShape shell(blade);
  ElementClearance clearance;
  const std::vector<MeshTriangle> patch = {{0, 1, 2}};
  const auto at = [&](double height) {
    const std::vector<Vec3> points = {{0.0, 0.0, height}, {1.0, 0.0, height}, {0.0, 1.0, height}};
    return clearance.keeps(shell, Transform(), points, patch, 0.01);
  };
  EXPECT_FALSE(at(0.0));
  EXPECT_FALSE(at(0.505));
  EXPECT_TRUE(at(0.52));
}

}  // namespace
}  // namespace curtain
