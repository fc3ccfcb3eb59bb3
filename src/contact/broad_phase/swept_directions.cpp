// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/swept_directions.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace curtain {
namespace {

// How far directions may be beyond those of a touch, as a share of their length. It only has to cover what the solve
// changes of the path: what is missed is found when that is verified.
constexpr double kBeside = 0.02;

}  // namespace

SweptDirections::SweptDirections(const QuadElements& quad, const Field3& start, const Field3& end) noexcept
    : edge_count_(quad.edge_count), face_count_(quad.triangle_count) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(edge_count_); ++k) {
    const MeshEdge& edge = quad.edges[k];
    edges_[k].along = {start.at(edge[1]) - start.at(edge[0]), end.at(edge[1]) - end.at(edge[0])};
    edges_[k].longest = std::sqrt(std::max(edges_[k].along[0].squaredNorm(), edges_[k].along[1].squaredNorm()));
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(face_count_); ++k) {
    const MeshTriangle& t = quad.triangles[k];
    const Vec3 a = start.at(t[1]) - start.at(t[0]), b = start.at(t[2]) - start.at(t[0]);
    const Vec3 c = end.at(t[1]) - end.at(t[0]), d = end.at(t[2]) - end.at(t[0]);
    faces_[k].normals = {Vec3(a.cross(b)), Vec3(0.5 * (a.cross(d) + c.cross(b))), Vec3(c.cross(d))};
    double square = 0.0;
    Vec3 low = faces_[k].normals[0], high = low;
    for (const Vec3& normal : faces_[k].normals) {
      square = std::max(square, normal.squaredNorm());
      low = low.cwiseMin(normal);
      high = high.cwiseMax(normal);
    }
    faces_[k].longest = std::sqrt(square);
    faces_[k].middle = 0.5 * (low + high);
    faces_[k].around = 0.5 * (high - low).norm();
  }
}

bool SweptDirections::edgesMeet(const NormalCone& normals) const noexcept {
  for (std::size_t k = 0; k < static_cast<std::size_t>(edge_count_); ++k) {
    const Edge& edge = edges_[k];
    const double a = normals.axis.dot(edge.along[0]), b = normals.axis.dot(edge.along[1]);
    const double least = (normals.sine + kBeside) * edge.longest;
    if (!(std::min(a, b) > least || std::max(a, b) < -least)) return true;
  }
  return false;
}

bool SweptDirections::edgeMeets(int edge, const ObstacleEdge& other) const noexcept {
  const Edge& mine = edges_[static_cast<std::size_t>(edge)];
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vec3& normal : other.normals) {
    for (const Vec3& direction : mine.along) {
      const double slope = normal.dot(direction);
      low = std::min(low, slope);
      high = std::max(high, slope);
    }
  }
  const double least = kBeside * mine.longest;
  return !(low > least || high < -least);
}

// A normal within the cone is no further across its axis than its sine says, on either side of the face.
bool SweptDirections::facesMeet(const NormalCone& normals) const noexcept {
  if (normals.sine >= 1.0) return true;
  for (std::size_t k = 0; k < static_cast<std::size_t>(face_count_); ++k) {
    const Face& face = faces_[k];
    const double within = (normals.sine + kBeside) * (face.middle.norm() + face.around) + face.around;
    if (!(normals.axis.cross(face.middle).norm() > within)) return true;
  }
  return false;
}

bool SweptDirections::faceMeets(int face, std::uint32_t vertex, const ObstacleFeatures& features) const noexcept {
  const Face& mine = faces_[static_cast<std::size_t>(face)];
  const double least = kBeside * mine.longest;
  bool rises = false, falls = false;  // some edge does, whenever it is looked at
  return !features.anyEdgeOf(vertex, [&](const Vec3& edge) {
    const double a = edge.dot(mine.normals[0]), b = edge.dot(mine.normals[1]), c = edge.dot(mine.normals[2]);
    rises = rises || std::min({a, b, c}) > least;
    falls = falls || std::max({a, b, c}) < -least;
    return rises && falls;
  });
}

}  // namespace curtain
