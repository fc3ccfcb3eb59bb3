// SPDX-License-Identifier: BSD-3-Clause
//
// Topology of a triangle mesh: closed or open, and the normals that tell inside from outside. Angle-weighted
// pseudonormals (Baerentzen, Aanaes 2005, "Signed distance computation using the angle weighted pseudonormal") give
// the right sign at faces, edges and corners of any closed mesh.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "curtain_sim/obstacle_shape.h"

namespace curtain {

/// Triangles lower than this share of their longest edge count as degenerate: rounding turns their normals by more
/// than 1e-4 rad.
constexpr double kDegenerateHeight = 1e-12;

bool isDegenerate(const Vec3& a, const Vec3& b, const Vec3& c) noexcept;

/// A sum of unit normals, made unit; the fallback where a knife edge cancels it.
Vec3 unitOrFallback(const Vec3& sum, const Vec3& fallback) noexcept;

/// A triangle's side, as it lies on an edge of the mesh.
struct MeshSide {
  int low, high;  ///< the edge's corners
  std::uint32_t triangle;
  std::uint32_t slot;  ///< 0 ab, 1 bc, 2 ca
  bool forward;        ///< the triangle runs along it from low to high
  bool sameEdge(const MeshSide& other) const { return low == other.low && high == other.high; }
};
/// All sides, those of one edge next to each other and in the order of the triangles.
std::vector<MeshSide> sortedSides(const ShapeTriangles& mesh);

/// Triangles of nonzero area with their normals, and a unit pseudonormal for each edge ab, bc, ca and each corner.
struct MeshTopology {
  ShapeTriangles mesh;  ///< degenerate triangles dropped; outward if watertight
  bool watertight = false;
  std::vector<Vec3> face_normals;
  std::vector<std::array<Vec3, 3>> edge_normals;
  std::vector<Vec3> corner_normals;
};

/// mesh: corners finite, equal corners shared, at least one non-degenerate triangle. Degenerate ones still connect
/// their neighbours: a mesh closed with them stays closed without.
MeshTopology analyseMesh(ShapeTriangles mesh);

}  // namespace curtain
