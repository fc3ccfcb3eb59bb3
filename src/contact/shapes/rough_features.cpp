// SPDX-License-Identifier: BSD-3-Clause
#include "contact/shapes/rough_features.h"

#include <algorithm>

namespace curtain {
namespace {

// Depth that is not put down to curvature, over the nodes' distance: the facets of a round surface take it.
constexpr double kFlatShare = 0.1;
// Triangles looked at around a corner: with more it counts as rough.
constexpr int kMostTriangles = 4000;

// The edges at a corner.
struct Star {
  double longest = 0.0;  // [m]
  double rise = 0.0;     // of the other ends over the corner's plane [m]
};

std::vector<Star> starsOf(const ObstacleFeatures& features) {
  std::vector<Star> stars(features.vertices().size());
  for (const ObstacleEdge& edge : features.edges()) {
    for (std::size_t k = 0; k < 2; ++k) {
      const Vec3 way = edge.ends[1 - k] - edge.ends[k];
      Star& star = stars[edge.vertices[k]];
      star.longest = std::max(star.longest, way.norm());
      star.rise = std::max(star.rise, features.vertices()[edge.vertices[k]].outward.dot(way));
    }
  }
  return stars;
}

// The surface around a corner, as seen from its plane.
struct Bend {
  double curvature = 0.0;  // [1/m]
  double spread = 0.0;     // largest square of a triangle's radius [m^2]
  bool graph = true;       // all of it faces the way the corner does
};

Bend bendAround(const ObstacleFeatures& features, const ObstacleVertex& corner, double radius, double flat) {
  const Vec3 margin = Vec3::Constant(radius);
  Bend bend;
  int count = 0;
  features.forEachTriangleIn({Vec3(corner.position - margin), Vec3(corner.position + margin)},
                             [&](std::uint32_t, const ObstacleTriangle& triangle) {
    if (!bend.graph || ++count > kMostTriangles || !(triangle.normal.dot(corner.outward) > 0.0)) {
      bend.graph = false;
      return;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 away = triangle.corners[k] - corner.position;
      const double depth = -corner.outward.dot(away) - flat;
      if (depth > 0.0) bend.curvature = std::max(bend.curvature, 2.0 * depth / away.squaredNorm());
      // No triangle needs a ball larger than that around an equilateral one with its longest side.
      bend.spread = std::max(bend.spread, (triangle.corners[(k + 1) % 3] - triangle.corners[k]).squaredNorm() / 3.0);
    }
  });
  return bend;
}

// Neither the corner nor the nearer half of an edge there can be met by an element. That the surface around faces one way puts
// all that is below it inside the solid. Mean squares: of the nodes about p, which is in the smallest ball around them; of p
// about the corner, core and half an edge away; of a facet's corners about a point of it.
bool isSmooth(const ObstacleFeatures& features, std::size_t vertex, const Star& star, const ClothGaps& gaps) {
  const double near = gaps.core + 0.5 * star.longest;
  const double flat = kFlatShare * gaps.kept;
  const double free = gaps.kept - gaps.core - flat - 0.5 * star.rise;
  if (!(free > 0.0)) return false;
  const Bend bend = bendAround(features, features.vertices()[vertex], gaps.longest + near + gaps.kept, flat);
  const double squares = 0.25 * gaps.longest * gaps.longest + near * near + bend.spread;
  return bend.graph && 0.5 * bend.curvature * squares <= free;
}

// Puts items into the order of a tree over their boxes.
BoxTree plant(const std::vector<Eigen::AlignedBox3d>& boxes, std::vector<std::uint32_t>& items) {
  BoxTree tree(boxes);
  std::vector<std::uint32_t> sorted;
  sorted.reserve(items.size());
  for (const std::uint32_t place : tree.order()) sorted.push_back(items[place]);
  items = std::move(sorted);
  return tree;
}

}  // namespace

RoughFeatures::RoughFeatures(const ObstacleFeatures& features, const ClothGaps& gaps) : features_(&features) {
  const std::vector<ObstacleVertex>& vertices = features.vertices();
  std::vector<std::uint8_t> smooth(vertices.size(), 0);
  // Of a shell both sides are free: what one of them bends from, the other is bent to.
  if (features.closed()) {
    const std::vector<Star> stars = starsOf(features);
    for (std::size_t n = 0; n < vertices.size(); ++n) smooth[n] = isSmooth(features, n, stars[n], gaps) ? 1 : 0;
  }
  is_rough_vertex_.assign(vertices.size(), 0);
  is_rough_edge_.assign(features.edges().size(), 0);
  std::vector<Eigen::AlignedBox3d> boxes;
  for (std::uint32_t n = 0; n < vertices.size(); ++n) {
    if (!vertices[n].touchable || smooth[n] != 0) continue;
    vertices_.push_back(n);
    is_rough_vertex_[n] = 1;
    boxes.emplace_back(vertices[n].position, vertices[n].position);
  }
  vertex_tree_ = plant(boxes, vertices_);
  boxes.clear();
  for (std::uint32_t n = 0; n < features.edges().size(); ++n) {
    const ObstacleEdge& edge = features.edges()[n];
    if (!edge.touchable || (smooth[edge.vertices[0]] != 0 && smooth[edge.vertices[1]] != 0)) continue;
    edges_.push_back(n);
    is_rough_edge_[n] = 1;
    boxes.emplace_back(edge.ends[0].cwiseMin(edge.ends[1]), edge.ends[0].cwiseMax(edge.ends[1]));
  }
  edge_tree_ = plant(boxes, edges_);
}

}  // namespace curtain
