// SPDX-License-Identifier: BSD-3-Clause
#include "obstacles/triangle_mesh_topology.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

namespace curtain {
namespace {

/// Passes along chains of degenerate triangles to find a normal; fans of slivers in CAD files are short.
constexpr int kBorrowPasses = 8;

/// Volume / area, as a share of the diagonal, below which a closed mesh is a doubled sheet without inside.
constexpr double kSheetThickness = 1e-9;

constexpr std::int64_t kNoPartner = -1;

const Vec3& cornerOf(const ShapeTriangles& mesh, std::size_t triangle, std::size_t corner) {
  return mesh.corners[static_cast<std::size_t>(mesh.triangles[triangle][static_cast<int>(corner % 3)])];
}

Vec3 unitOrZero(const Vec3& v) {
  const double norm = v.norm();
  return norm > 0.0 ? Vec3(v / norm) : Vec3(Vec3::Zero());
}

/// For every slot (3 * triangle + edge) the slot on the other side of the edge. Returns whether the mesh is closed:
/// every edge has exactly two triangles, which run along it in opposite directions.
bool findPartners(const ShapeTriangles& mesh, std::vector<std::int64_t>& partners) {
  const std::vector<MeshSide> sides = sortedSides(mesh);
  const auto slotOf = [&sides](std::size_t n) { return 3 * std::size_t{sides[n].triangle} + sides[n].slot; };
  partners.assign(sides.size(), kNoPartner);
  bool closed = true;
  for (std::size_t first = 0; first < sides.size();) {
    std::size_t next = first + 1;
    while (next < sides.size() && sides[next].sameEdge(sides[first])) ++next;
    if (next - first == 2 && sides[first].forward != sides[first + 1].forward) {
      partners[slotOf(first)] = static_cast<std::int64_t>(slotOf(first + 1));
      partners[slotOf(first + 1)] = static_cast<std::int64_t>(slotOf(first));
    } else {
      closed = false;
    }
    first = next;
  }
  return closed;
}

/// > 0: has an inside, faces outward; < 0: faces inward; 0: a doubled sheet without inside.
int orientation(const ShapeTriangles& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& corner : mesh.corners) {
    box.extend(corner);
  }
  const Vec3 centre = box.center();  // relative to the centre, against cancellation
  double volume = 0.0;
  double area = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = cornerOf(mesh, t, 0) - centre;
    const Vec3 b = cornerOf(mesh, t, 1) - centre;
    const Vec3 c = cornerOf(mesh, t, 2) - centre;
    volume += a.dot(b.cross(c)) / 6.0;
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  if (std::abs(volume) <= kSheetThickness * area * box.diagonal().norm()) return 0;
  return volume > 0.0 ? 1 : -1;
}

std::size_t longestEdge(const ShapeTriangles& mesh, std::size_t triangle) {
  std::size_t longest = 0;
  double length = -1.0;
  for (std::size_t e = 0; e < 3; ++e) {
    const double candidate = (cornerOf(mesh, triangle, e + 1) - cornerOf(mesh, triangle, e)).squaredNorm();
    if (candidate > length) {
      length = candidate;
      longest = e;
    }
  }
  return longest;
}

/// A degenerate triangle lies on its longest edge and takes the normal of the neighbour there, as if that reached
/// across.
void borrowNormals(const ShapeTriangles& mesh, const std::vector<std::int64_t>& partners,
                   const std::vector<std::size_t>& degenerate, std::vector<Vec3>& normals) {
  for (int pass = 0; pass < kBorrowPasses; ++pass) {
    for (const std::size_t t : degenerate) {
      const std::int64_t partner = partners[3 * t + longestEdge(mesh, t)];
      if (partner != kNoPartner) normals[t] = normals[static_cast<std::size_t>(partner) / 3];
    }
  }
}

/// Normal of the surface across an edge; zero: nothing there.
Vec3 normalAcross(const ShapeTriangles& mesh, const std::vector<std::int64_t>& partners,
                  const std::vector<bool>& is_degenerate, const std::vector<Vec3>& normals, std::size_t slot) {
  if (partners[slot] == kNoPartner) return Vec3::Zero();
  const auto other_slot = static_cast<std::size_t>(partners[slot]);
  const std::size_t other = other_slot / 3;
  if (!is_degenerate[other] || other_slot % 3 != longestEdge(mesh, other)) return normals[other];
  // Across its longest edge a degenerate triangle stands for the neighbours at its short edges.
  Vec3 sum = Vec3::Zero();
  for (std::size_t e = 1; e < 3; ++e) {
    const std::int64_t beyond = partners[3 * other + (other_slot + e) % 3];
    if (beyond != kNoPartner) sum += normals[static_cast<std::size_t>(beyond) / 3];
  }
  return unitOrZero(sum);
}

/// Sums of the face normals around each corner, weighted by angle.
std::vector<Vec3> cornerNormals(const ShapeTriangles& mesh, const std::vector<Vec3>& normals) {
  std::vector<Vec3> sums(mesh.corners.size(), Vec3::Zero());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 one = cornerOf(mesh, t, i + 1) - cornerOf(mesh, t, i);
      const Vec3 other = cornerOf(mesh, t, i + 2) - cornerOf(mesh, t, i);
      const double angle = std::atan2(one.cross(other).norm(), one.dot(other));
      sums[static_cast<std::size_t>(mesh.triangles[t][static_cast<int>(i)])] += angle * normals[t];
    }
  }
  for (Vec3& sum : sums) {
    sum = unitOrFallback(sum, Vec3::Zero());
  }
  return sums;
}

}  // namespace

std::vector<MeshSide> sortedSides(const ShapeTriangles& mesh) {
  std::vector<MeshSide> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int e = 0; e < 3; ++e) {
      const int from = mesh.triangles[t][e];
      const int to = mesh.triangles[t][(e + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), static_cast<std::uint32_t>(t),
                       static_cast<std::uint32_t>(e), from < to});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const MeshSide& one, const MeshSide& other) {
    return std::tie(one.low, one.high, one.triangle, one.slot) <
           std::tie(other.low, other.high, other.triangle, other.slot);
  });
  return sides;
}

Vec3 unitOrFallback(const Vec3& sum, const Vec3& fallback) noexcept {
  const double norm = sum.norm();
  return norm > 1e-9 ? Vec3(sum / norm) : fallback;
}

bool isDegenerate(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  const double longest_squared = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  const double height_by_edge = (b - a).cross(c - a).norm();
  return !(height_by_edge > kDegenerateHeight * longest_squared);
}

MeshTopology analyseMesh(ShapeTriangles mesh) {
  MeshTopology topology;
  std::vector<std::int64_t> partners;
  topology.watertight = findPartners(mesh, partners);
  const int outward = topology.watertight ? orientation(mesh) : 0;
  topology.watertight = outward != 0;
  if (outward < 0) {
    for (Eigen::Vector3i& triangle : mesh.triangles) {
      std::swap(triangle[1], triangle[2]);
    }
    findPartners(mesh, partners);
  }
  const std::size_t count = mesh.triangles.size();
  std::vector<Vec3> normals(count, Vec3::Zero());
  std::vector<bool> is_degenerate(count);
  std::vector<std::size_t> degenerate;
  for (std::size_t t = 0; t < count; ++t) {
    const Vec3& a = cornerOf(mesh, t, 0);
    is_degenerate[t] = isDegenerate(a, cornerOf(mesh, t, 1), cornerOf(mesh, t, 2));
    if (is_degenerate[t]) {
      degenerate.push_back(t);
    } else {
      normals[t] = (cornerOf(mesh, t, 1) - a).cross(cornerOf(mesh, t, 2) - a).normalized();
    }
  }
  borrowNormals(mesh, partners, degenerate, normals);
  topology.corner_normals = cornerNormals(mesh, normals);
  for (std::size_t t = 0; t < count; ++t) {
    if (is_degenerate[t]) continue;
    std::array<Vec3, 3> edges;
    for (std::size_t e = 0; e < 3; ++e) {
      const Vec3 across = normalAcross(mesh, partners, is_degenerate, normals, 3 * t + e);
      edges[e] = unitOrFallback(normals[t] + across, normals[t]);
    }
    topology.mesh.triangles.push_back(mesh.triangles[t]);
    topology.face_normals.push_back(normals[t]);
    topology.edge_normals.push_back(edges);
  }
  topology.mesh.corners = std::move(mesh.corners);
  return topology;
}

}  // namespace curtain
