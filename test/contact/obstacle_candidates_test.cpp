// SPDX-License-Identifier: BSD-3-Clause
//
// Candidates for contact, against all there are: what comes within reach of an obstacle on its way is listed, what has
// no room is told.
#include "contact/broad_phase/obstacle_candidates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "contact/narrow_phase/closest_points.h"
#include "contact/narrow_phase/element_pairs.h"
#include "testing.h"

namespace curtain {
namespace {

using namespace curtain_test;

// So thin that faces come nearer to the ball than their nodes may: they are looked at too.
constexpr double kThickness = 0.008, kRadius = 0.2;

// A ball that stands still anywhere, and ways of cloth past it.
struct Past {
  explicit Past(std::uint64_t seed) : random(seed) {
    scene.pins.kind = PinKind::kNone;
    ObstacleParams ball = ballAt(random.inBox(10.0), kRadius);
    scene.obstacles.push_back(ball);
    middle = ball.pose.position;
    obstacles.emplace(scene, shapesBy(resolveMeshUrl));
    near.emplace(pattern, *moving().shape, ObstacleGaps{kThickness, 0.3 * kThickness}, alone);
  }
  const MovingObstacle& moving() { return obstacles->moving(0); }
  // Flat cloth of links of 5 cm at this height over the middle, each node moved by up to `way`.
  void lay(double height, double way) {
    start.assign(pattern.grid.size(), 0.0);
    for (int i = 0; i < pattern.grid.rows; ++i) {
      for (int j = 0; j < pattern.grid.columns; ++j) {
        start.set(pattern.grid.index(i, j), middle + Vec3(0.05 * (i - 7), 0.05 * (j - 7), height) + random.inBox(0.01));
      }
    }
    end = start;
    for (std::size_t n = 0; n < pattern.grid.size(); ++n) end.add(n, random.inBox(way));
    near->prepare(moving(), start, end);
  }

  Random random;
  Scene scene = flatScene(15, 15, 0.7, 0.7);
  ClothPattern pattern = makePattern(scene);
  Vec3 middle = Vec3::Zero();
  std::optional<ObstacleSet> obstacles;
  const Workers alone{1};
  std::optional<ObstacleCandidates> near;
  Field3 start, end;
};

TEST(ObstacleCandidates, ListsEveryNodeThatComesWithinReachOnItsWayAndNotAll) {
  int listed = 0, within = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Past past(seed);
    past.lay(past.random.between(0.8, 1.2) * kRadius, past.random.between(0.0, 0.05));
    const std::set<std::uint32_t> nodes(past.near->nodes().begin(), past.near->nodes().end());
    EXPECT_EQ(nodes.size(), past.near->nodes().size()) << "once each";
    for (int i = 0; i < 15; ++i) {
      for (int j = 0; j < 15; ++j) {
        const auto n = static_cast<std::uint32_t>(past.pattern.grid.index(i, j));
        const Vec3 way = past.end.at(n) - past.start.at(n), from = past.start.at(n) - past.middle;
        const double t = std::clamp(-from.dot(way) / way.squaredNorm(), 0.0, 1.0);
        if ((from + t * way).norm() - kRadius > past.near->nodeReach()) continue;
        EXPECT_EQ(nodes.count(n), 1u) << seed << ": " << i << ", " << j;
        ++within;
      }
    }
    listed += static_cast<int>(nodes.size());
    all += 225;
  }
  EXPECT_GT(within, 1000);
  EXPECT_LT(listed, all / 2);
}

TEST(ObstacleCandidates, ListsEveryFaceThatEndsWithinReachAndNotAll) {
  int listed = 0, within = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Past past(seed);
    past.lay(past.random.between(1.0, 1.2) * kRadius, past.random.between(0.0, 0.05));
    std::set<std::array<std::uint32_t, 3>> faces;
    for (const ObstacleCandidates::Face& face : past.near->faces()) {
      std::array<std::uint32_t, 3> nodes{face.node[0], face.node[1], face.node[2]};
      std::sort(nodes.begin(), nodes.end());
      EXPECT_TRUE(faces.insert(nodes).second) << "once each";
    }
    const CoarseMesh mesh = makeCoarseMesh(past.pattern.grid);
    for (const MeshTriangle& triangle : mesh.triangles) {
      ++all;
      const Vec3 a = past.end.at(triangle[0]), b = past.end.at(triangle[1]), c = past.end.at(triangle[2]);
      const double distance = std::sqrt(closestOnTriangle(past.middle, a, b, c).distance_squared) - kRadius;
      if (distance > past.near->elementReach()) continue;
      std::array<std::uint32_t, 3> nodes{triangle[0], triangle[1], triangle[2]};
      std::sort(nodes.begin(), nodes.end());
      EXPECT_EQ(faces.count(nodes), 1u) << seed << ": at " << distance;
      ++within;
    }
    listed += static_cast<int>(faces.size());
  }
  EXPECT_GT(within, 1000);
  EXPECT_LT(listed, all / 4);
}

TEST(Candidates, ThatHaveNoRoomAreNotTakenButTold) {
  Candidates candidates;
  candidates.reserve(2);
  for (int k = 0; k < 2; ++k) candidates.add(VertexTriangle{});
  candidates.add(EdgeEdge{});
  EXPECT_FALSE(candidates.full);
  candidates.add(VertexTriangle{});
  EXPECT_TRUE(candidates.full);
  EXPECT_EQ(candidates.vertex_triangles.size(), 2u);
  EXPECT_EQ(candidates.edge_edges.size(), 1u);
  candidates.clear();
  EXPECT_FALSE(candidates.full);
  EXPECT_TRUE(candidates.vertex_triangles.empty() && candidates.edge_edges.empty());
  EXPECT_EQ(candidates.vertex_triangles.capacity(), 2u) << "kept for the next";
}

}  // namespace
}  // namespace curtain
