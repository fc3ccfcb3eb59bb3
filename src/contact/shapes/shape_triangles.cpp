// SPDX-License-Identifier: BSD-3-Clause
//
// Triangles of the analytic obstacles for drawing, wound so that their normals point outward. The round ones are
// a profile turned about z, fine enough to look round at the size of a window.
#include <cmath>

#include "contact/shapes/shapes.h"
#include "scene/pi.h"

namespace curtain {
namespace {

constexpr int kSegments = 48;          // around the axis
constexpr int kArcs = 12;              // pole to equator
constexpr double kPlaneHalf = 5.0;     // of the square that stands for a plane [m]

using Profile = std::vector<Eigen::Vector2d>;  // (radius, z) from the lower to the upper pole, ends on the axis

/// Quarter circle around (0, centre) from angle `from` [rad, 0 = equator] to a quarter turn further, ends included.
void appendArc(double radius, double centre, double from, Profile& profile) {
  for (int i = 0; i <= kArcs; ++i) {
    const double angle = from + 0.5 * kPi * i / kArcs;
    profile.emplace_back(radius * std::cos(angle), centre + radius * std::sin(angle));
  }
}

ShapeTriangles turnAboutZ(const Profile& profile) {
  ShapeTriangles shape;
  const int rings = static_cast<int>(profile.size()) - 2;  // without the poles
  shape.corners.emplace_back(0.0, 0.0, profile.front().y());
  for (int r = 1; r <= rings; ++r) {
    const Eigen::Vector2d& ring = profile[static_cast<std::size_t>(r)];
    for (int s = 0; s < kSegments; ++s) {
      const double angle = 2.0 * kPi * s / kSegments;
      shape.corners.emplace_back(ring.x() * std::cos(angle), ring.x() * std::sin(angle), ring.y());
    }
  }
  shape.corners.emplace_back(0.0, 0.0, profile.back().y());
  const int top = rings * kSegments + 1;
  const auto corner = [](int ring, int segment) { return 1 + ring * kSegments + segment % kSegments; };
  for (int s = 0; s < kSegments; ++s) {
    shape.triangles.emplace_back(0, corner(0, s + 1), corner(0, s));
    for (int r = 0; r + 1 < rings; ++r) {
      shape.triangles.emplace_back(corner(r, s), corner(r, s + 1), corner(r + 1, s + 1));
      shape.triangles.emplace_back(corner(r, s), corner(r + 1, s + 1), corner(r + 1, s));
    }
    shape.triangles.emplace_back(corner(rings - 1, s), corner(rings - 1, s + 1), top);
  }
  return shape;
}

}  // namespace

ShapeTriangles SphereShape::triangles() const {
  Profile profile;
  appendArc(radius_, 0.0, -0.5 * kPi, profile);
  profile.pop_back();  // the equator comes with the upper half
  appendArc(radius_, 0.0, 0.0, profile);
  return turnAboutZ(profile);
}

ShapeTriangles BoxShape::triangles() const {
  ShapeTriangles shape;
  for (int i = 0; i < 8; ++i) {
    shape.corners.emplace_back(i & 1 ? half_.x() : -half_.x(), i & 2 ? half_.y() : -half_.y(),
                               i & 4 ? half_.z() : -half_.z());
  }
  shape.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                     {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return shape;
}

/// By construction, not by analysis: a box thinner than rounding has six faces, too.
MeshTopology BoxShape::topology() const {
  MeshTopology topology;
  topology.mesh = triangles();
  topology.watertight = true;
  for (const int face : {-3, 3, -2, 2, -1, 1}) {  // axis and side, in the order of triangles()
    const Vec3 normal = (face < 0 ? -1.0 : 1.0) * Vec3::Unit(std::abs(face) - 1);
    topology.face_normals.insert(topology.face_normals.end(), 2, normal);
    topology.edge_normals.insert(topology.edge_normals.end(), 2, {normal, normal, normal});
  }
  for (const Vec3& corner : topology.mesh.corners) {
    topology.corner_normals.push_back(corner.cwiseSign().normalized());
  }
  return topology;
}

ShapeTriangles CylinderShape::triangles() const {
  return turnAboutZ({{0.0, -half_}, {radius_, -half_}, {radius_, half_}, {0.0, half_}});
}

ShapeTriangles CapsuleShape::triangles() const {
  Profile profile;
  appendArc(radius_, -half_, -0.5 * kPi, profile);
  appendArc(radius_, half_, 0.0, profile);
  return turnAboutZ(profile);
}

ShapeTriangles PlaneShape::triangles() const {
  ShapeTriangles shape;
  shape.corners = {{-kPlaneHalf, -kPlaneHalf, 0.0},
                   {kPlaneHalf, -kPlaneHalf, 0.0},
                   {kPlaneHalf, kPlaneHalf, 0.0},
                   {-kPlaneHalf, kPlaneHalf, 0.0}};
  shape.triangles = {{0, 1, 2}, {0, 2, 3}};
  return shape;
}

}  // namespace curtain
