// SPDX-License-Identifier: BSD-3-Clause
//
// Windows against all edges and corners of the mesh: a quad that they call clear keeps its reach from each of them all
// the way, and of one that is near they name all within reach at which an edge or a face of it may be nearest.
#include "contact/broad_phase/mesh_clearance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "contact/bumpy_sphere.h"
#include "contact/narrow_phase/closest_points.h"
#include "obstacles/triangle_mesh.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::bumpySphere;
using curtain_test::Random;

/// Triangles of some `size` [m] anywhere in a box: both sides of each are free.
ShapeTriangles soup(int count, double size, Random& random) {
  ShapeTriangles mesh;
  for (int t = 0; t < count; ++t) {
    const Vec3 place = random.inBox(1.0);
    for (int k = 0; k < 3; ++k) mesh.corners.push_back(place + random.inBox(size));
    mesh.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
  }
  return mesh;
}

/// Indices of edges, and of corners, of a mesh.
struct Touched {
  std::set<std::uint32_t> edges, corners;
};

/// What of the mesh comes within reach of a quad cut along either diagonal, at five times of its way.
Touched withinReach(const ObstacleFeatures& features, const QuadElements& quad, const Field3& start, const Field3& end,
                    double reach) {
  Touched touched;
  const std::array<std::array<std::size_t, 3>, 4> triangles{{{0, 2, 1}, {1, 2, 3}, {0, 2, 3}, {0, 3, 1}}};
  for (int step = 0; step <= 4; ++step) {
    std::array<Vec3, 4> at;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t n = quad.corners[k];
      at[k] = start.at(n) + 0.25 * step * (end.at(n) - start.at(n));
    }
    for (std::uint32_t v = 0; v < features.vertices().size(); ++v) {
      const ObstacleVertex& vertex = features.vertices()[v];
      if (!vertex.touchable) continue;
      for (const auto& t : triangles) {
        const double square = closestOnTriangle(vertex.position, at[t[0]], at[t[1]], at[t[2]]).distance_squared;
        if (square <= reach * reach) touched.corners.insert(v);
      }
    }
    for (std::uint32_t e = 0; e < features.edges().size(); ++e) {
      const ObstacleEdge& edge = features.edges()[e];
      if (!edge.touchable) continue;
      for (const auto& [a, b] : {std::pair(0U, 1U), {0U, 2U}, {1U, 3U}, {2U, 3U}, {1U, 2U}, {0U, 3U}}) {
        const double square = closestOnSegments(at[a], at[b], edge.ends[0], edge.ends[1]).distance_squared;
        if (square <= reach * reach) touched.edges.insert(e);
      }
    }
  }
  return touched;
}

/// Whether the mesh goes away on both sides of an edge, seen from a point that is `apart` from a point of it.
bool goesAway(const ObstacleFeatures& features, const ObstacleEdge& edge, const Vec3& apart) {
  if (edge.faces[1] == kNoFace || edge.bend == EdgeBend::kBranch) return true;
  const Vec3 along = (edge.ends[1] - edge.ends[0]).normalized();
  for (const std::uint32_t face : edge.faces) {
    for (const Vec3& corner : features.triangles()[face].corners) {
      Vec3 inwards = corner - edge.ends[0];
      inwards -= along.dot(inwards) * along;
      if (inwards.norm() > 1e-9 && apart.dot(inwards) > 0.0) return false;
    }
  }
  return true;
}

/// The same of a vertex, from the ends of its edges.
bool goesAway(const ObstacleFeatures& features, std::uint32_t vertex, const Vec3& apart) {
  for (const ObstacleEdge& edge : features.edges()) {
    for (std::size_t k = 0; k < 2; ++k) {
      if (edge.vertices[k] == vertex && apart.dot(edge.ends[1 - k] - edge.ends[k]) > 0.0) return false;
    }
  }
  return true;
}

/// Where at one of five times an edge or a face of the quad has its nearest point of the mesh around, within reach.
Touched nearestWithin(const ObstacleFeatures& features, const QuadElements& quad, const Field3& start,
                      const Field3& end, double reach) {
  Touched touched;
  for (int step = 0; step <= 4; ++step) {
    const auto at = [&](std::uint32_t n) { return Vec3(start.at(n) + 0.25 * step * (end.at(n) - start.at(n))); };
    for (int k = 0; k < quad.triangle_count; ++k) {
      const MeshTriangle& t = quad.triangles[static_cast<std::size_t>(k)];
      const std::array<Vec3, 3> p{at(t[0]), at(t[1]), at(t[2])};
      for (std::uint32_t v = 0; v < features.vertices().size(); ++v) {
        if (!features.vertices()[v].touchable) continue;
        const Vec3& corner = features.vertices()[v].position;
        const TriangleClosest found = closestOnTriangle(corner, p[0], p[1], p[2]);
        const Vec3 apart = found.weights[0] * p[0] + found.weights[1] * p[1] + found.weights[2] * p[2] - corner;
        const bool inside = found.weights.minCoeff() > 0.0;
        if (inside && found.distance_squared <= reach * reach && goesAway(features, v, apart))
          touched.corners.insert(v);
      }
    }
    for (int k = 0; k < quad.edge_count; ++k) {
      const Vec3 a = at(quad.edges[static_cast<std::size_t>(k)][0]), b = at(quad.edges[static_cast<std::size_t>(k)][1]);
      for (std::uint32_t e = 0; e < features.edges().size(); ++e) {
        const ObstacleEdge& edge = features.edges()[e];
        if (!edge.touchable) continue;
        const auto& [c, d] = edge.ends;
        const SegmentsClosest found = closestOnSegments(a, b, c, d);
        const bool inside = found.s > 0.0 && found.s < 1.0 && found.t > 0.0 && found.t < 1.0;
        const Vec3 apart = a + found.s * (b - a) - c - found.t * (d - c);
        if (inside && found.distance_squared <= reach * reach && goesAway(features, edge, apart))
          touched.edges.insert(e);
      }
    }
  }
  return touched;
}

struct Seen {
  int nearest = 0;
  int clear = 0, near = 0, held = 0, most = 0;
};

/// Asks the windows about one way of the cloth and compares.
void look(MeshClearance& windows, const Grid& grid, const ObstacleFeatures& features, const Field3& start,
          const Field3& end, double reach, Seen& seen) {
  for (int i = 0; i + 1 < grid.rows; ++i) {
    const QuadClearance* const views = windows.classify(i, start, end, reach);
    for (int j = 0; j < grid.linkCount(); ++j) {
      const QuadElements quad = quadElements(grid, i, j);
      const SweptQuad way(quad, start, end);
      QuadClearance view = views[j];
      if (view == QuadClearance::kUnknown)
        view = windows.rebuild(quad, way, reach);
      else
        ++seen.held;
      ASSERT_NE(view, QuadClearance::kUnknown);
      Touched truth, named;
      if (view == QuadClearance::kNear) {
        Eigen::AlignedBox3d box;
        for (const std::uint32_t n : quad.corners) box.extend(start.at(n)).extend(end.at(n));
        box.min().array() -= reach;
        box.max().array() += reach;
        const SweptDirections directions(quad, start, end);
        windows.forEachNear(
            quad, way, directions, reach, box,
            [&](std::uint32_t e, const ObstacleEdge& edge) {
              bool meets = false;
              for (int k = 0; k < quad.edge_count; ++k) meets = meets || directions.edgeMeets(k, edge);
              EXPECT_TRUE(!meets || named.edges.insert(e).second);
            },
            [&](std::uint32_t v, const ObstacleVertex&) {
              bool meets = false;
              for (int k = 0; k < quad.triangle_count; ++k) meets = meets || directions.faceMeets(k, v, features);
              EXPECT_TRUE(!meets || named.corners.insert(v).second);
            });
        truth = nearestWithin(features, quad, start, end, reach);
        seen.nearest += static_cast<int>(truth.edges.size() + truth.corners.size());
        ++seen.near;
        seen.most = std::max(seen.most, static_cast<int>(named.edges.size() + named.corners.size()));
      } else {
        truth = withinReach(features, quad, start, end, reach);
        ++seen.clear;
      }
      EXPECT_TRUE(std::includes(named.edges.begin(), named.edges.end(), truth.edges.begin(), truth.edges.end()));
      EXPECT_TRUE(
          std::includes(named.corners.begin(), named.corners.end(), truth.corners.begin(), truth.corners.end()));
    }
  }
}

/// Cloth that wanders over the mesh, its nodes at some height of its surface at x^2 + y^2 + z^2 = 1.
Seen wander(const Grid& grid, const TriangleMeshShape& mesh, double link, double height, std::uint64_t seed) {
  Random random(seed);
  MeshClearance windows(grid, mesh);
  Field3 start, end;
  start.assign(grid.size(), 0.0);
  end.assign(grid.size(), 0.0);
  Seen seen;
  Vec3 place = random.direction();
  for (int step = 0; step < 40; ++step) {
    if (step % 8 == 0) place = random.direction();
    const Vec3 next = (place + random.inBox(0.02)).normalized();
    const double reach = random.between(0.001, 0.01);
    const auto put = [&](const Vec3& middle, Field3& at) {
      const Vec3 right = middle.unitOrthogonal(), down = middle.cross(right);
      for (int i = 0; i < grid.rows; ++i) {
        for (int j = 0; j < grid.columns; ++j) {
          const Vec3 flat = middle + link * (i - 0.5 * grid.rows) * down + link * (j - 0.5 * grid.columns) * right;
          at.set(grid.index(i, j), (1.0 + height) * flat.normalized() + random.inBox(0.1 * link));
        }
      }
    };
    if (step % 8 == 0) put(place, start);
    put(next, end);
    look(windows, grid, *mesh.features(), start, end, reach, seen);
    std::swap(start, end);
    place = next;
  }
  return seen;
}

TEST(MeshClearance, MissNothingOfASolid) {
  const TriangleMeshShape mesh(bumpySphere(24, 40, 0.03, 9.0, 7.0));
  ASSERT_TRUE(mesh.watertight());
  for (const bool closed : {false, true}) {
    const Seen seen = wander(Grid{4, 5, closed}, mesh, 0.06, 0.02, 7);
    EXPECT_GT(seen.clear, 50);
    EXPECT_GT(seen.near, 50);
    EXPECT_GT(seen.held, 100);
  }
}

TEST(MeshClearance, MissNothingOfAShell) {
  Random random(3);
  const TriangleMeshShape mesh(soup(400, 0.15, random));
  const Seen seen = wander(Grid{4, 5, false}, mesh, 0.06, -0.4, 8);
  EXPECT_GT(seen.clear, 20);
  EXPECT_GT(seen.near, 50);
}

TEST(MeshClearance, MissNothingWhereThereIsMuchMoreThanTheyKeep) {
  const TriangleMeshShape mesh(bumpySphere(60, 100, 0.02, 9.0, 7.0));
  const Seen seen = wander(Grid{3, 3, false}, mesh, 0.3, 0.0, 9);
  EXPECT_GT(seen.near, 50);
  EXPECT_GT(seen.most, 100);
  EXPECT_GT(seen.nearest, 100);
}

TEST(MeshClearance, CallNothingClearThatIsNotANumberOrFarAway) {
  const TriangleMeshShape mesh(bumpySphere(24, 40, 0.03, 9.0, 7.0));
  const Grid grid{3, 9, false};
  MeshClearance windows(grid, mesh);
  Field3 start;
  start.assign(grid.size(), 0.0);
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) start.set(grid.index(i, j), Vec3(0.1 * j, 0.1 * i, 1.5));
  }
  for (int j = 0; j < grid.linkCount(); ++j) {
    const QuadElements quad = quadElements(grid, 0, j);
    ASSERT_EQ(windows.rebuild(quad, SweptQuad(quad, start, start), 0.01), QuadClearance::kClear);
  }
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200}) {
    Field3 end = start;
    end.y[grid.index(1, 4)] = bad;
    const QuadClearance* const views = windows.classify(0, start, end, 0.01);
    for (int j = 0; j < grid.linkCount(); ++j) {
      const bool has_it = j == 3 || j == 4;
      EXPECT_EQ(views[j], has_it ? QuadClearance::kUnknown : QuadClearance::kClear) << bad << " quad " << j;
    }
  }
}

}  // namespace
}  // namespace curtain
