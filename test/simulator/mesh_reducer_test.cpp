// SPDX-License-Identifier: BSD-3-Clause
//
// The reduced mesh on cloth that hangs, blows and lies on things, and on nodes strewn at random: it has no cracks, is
// no further from the fine mesh than it may be, and is the fine mesh itself where nothing may be left out.
#include "curtain_sim/mesh_reducer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "contact/narrow_phase/closest_points.h"
#include "curtain_sim/scene_yaml.h"
#include "curtain_sim/simulator.h"
#include "figures.h"
#include "testing.h"

namespace curtain {
namespace {

using Triangles = MeshReducer::Triangles;

MeshDetail seenFrom(const Vec3& viewer, double angle) {
  MeshDetail detail;
  detail.viewer = viewer;
  detail.viewer_tolerance = angle;
  return detail;
}

MeshDetail within(double tolerance) {
  MeshDetail detail;
  detail.tolerance = tolerance;
  return detail;
}

/// A fine mesh with its topology.
struct Cloth {
  FineMeshTopology topology;
  FineMesh mesh;
};

/// A shipped scene with that many rods a link, after so many frames.
Cloth shipped(const std::string& name, int folds, int frames) {
  SceneReading reading = readSceneFile(std::string(CURTAIN_SOURCE_DIR) + "/config/scenes/" + name + ".yaml");
  EXPECT_TRUE(reading.problems.empty()) << describe(reading.problems);
  reading.scene.cloth.folds = folds;
  Simulator simulator(reading.scene);
  for (int frame = 0; frame < frames; ++frame) simulator.step();
  Cloth cloth{simulator.fineMeshTopology(), {}};
  simulator.copyFineMesh(cloth.mesh);
  return cloth;
}

/// Nodes anywhere in a box: folds of every level meet, links are twisted.
Cloth strewn(int rows, int columns, int folds, bool closed, std::uint64_t seed) {
  ClothParams params;
  params.rows = rows;
  params.columns = columns;
  params.folds = folds;
  params.closed = closed;
  Cloth cloth{makeFineMeshTopology(params), {}};
  curtain_test::Random random(seed);
  const int count = cloth.topology.rows * cloth.topology.columns;
  for (int i = 0; i < count; ++i) {  // from almost straight links to none
    const double width = std::pow(10.0, random.between(-4.0, -1.0));
    const int row = i / cloth.topology.columns;
    const double along = 0.02 * (i % cloth.topology.columns);
    cloth.mesh.positions.push_back(Vec3(along, 0.0, -0.1 * row) + random.inBox(width));
  }
  return cloth;
}

std::vector<Cloth> cloths() {
  std::vector<Cloth> all;
  all.push_back(shipped("curtain", 6, 40));
  all.push_back(shipped("curtain", 5, 0));
  all.push_back(shipped("flag", 13, 30));
  all.push_back(shipped("skirt", 6, 30));
  all.push_back(strewn(7, 5, 6, false, 1));
  all.push_back(strewn(6, 3, 7, true, 2));
  all.push_back(strewn(5, 4, 16, true, 3));
  return all;
}

std::vector<MeshDetail> details() {
  return {within(1e-4),
          within(1e-3),
          within(0.01),
          within(1.0),
          seenFrom(Vec3(0.3, -0.4, 1.5), 2e-3),
          seenFrom(Vec3(0.1, 0.0, -0.1), 0.05),
          seenFrom(Vec3(0.5, -20.0, 1.0), 1e-3)};
}

TEST(MeshReducer, WithoutAToleranceTheMeshIsTheFineOne) {
  for (const Cloth& cloth : cloths()) {
    MeshReducer reducer(cloth.topology);
    EXPECT_EQ(&reducer.reduce(cloth.mesh, MeshDetail()), &cloth.topology.triangles);
    EXPECT_EQ(&reducer.reduce(cloth.mesh, seenFrom(Vec3(0.0, 1.0, 0.0), 0.0)), &cloth.topology.triangles);
  }
}

// Between full folds a strip is cut as the fine mesh cuts it, in the same order.
TEST(MeshReducer, FullFoldsGiveTheFineTriangles) {
  const Cloth cloth = strewn(7, 5, 6, false, 1);
  MeshReducer reducer(cloth.topology);
  EXPECT_EQ(reducer.reduce(cloth.mesh, within(1e-300)), cloth.topology.triangles);
}

// As in the fine mesh, every edge has a triangle on either side, wound the same way, but for those of the cloth's
// border; and it is still a disc or an annulus.
TEST(MeshReducer, LeavesNoCracks) {
  int mixed = 0;
  for (const Cloth& cloth : cloths()) {
    const FineMeshTopology& topology = cloth.topology;
    MeshReducer reducer(topology);
    for (const MeshDetail& detail : details()) {
      const Triangles& triangles = reducer.reduce(cloth.mesh, detail);
      std::set<std::pair<std::uint32_t, std::uint32_t>> directed;
      std::set<std::uint32_t> used;
      for (const auto& triangle : triangles) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
          used.insert(triangle[corner]);
          EXPECT_TRUE(directed.insert({triangle[corner], triangle[(corner + 1) % 3]}).second) << "twice the same way";
        }
      }
      long edges = 0;
      for (const auto& [from, to] : directed) {
        const bool both = directed.count({to, from}) > 0;
        edges += !both || from < to;
        if (both) continue;
        const auto columns = static_cast<std::uint32_t>(topology.columns);
        const auto last_row = static_cast<std::uint32_t>(topology.rows - 1);
        const bool in_end_row = from / columns == to / columns && (from / columns == 0 || from / columns == last_row);
        const bool at_side = !topology.closed && from % columns == to % columns &&
                             (from % columns == 0 || from % columns == columns - 1);
        EXPECT_TRUE(in_end_row || at_side) << "a crack at the edge " << from << " - " << to;
      }
      const auto euler = static_cast<long>(used.size()) - edges + static_cast<long>(triangles.size());
      EXPECT_EQ(euler, topology.closed ? 0 : 1);
      const std::size_t fewest = 2u * static_cast<std::size_t>(topology.rows - 1) *
                                 static_cast<std::size_t>(topology.columns / topology.folds);
      mixed += triangles.size() > fewest && triangles.size() < topology.triangles.size();
    }
  }
  EXPECT_GT(mixed, 15) << "folds of different detail must have met";
}

/// Triangles by strip: the upper row and the link.
using Strips = std::map<std::pair<std::uint32_t, std::uint32_t>, Triangles>;

Strips stripsOf(const Triangles& triangles, const FineMeshTopology& topology) {
  const auto columns = static_cast<std::uint32_t>(topology.columns);
  const auto folds = static_cast<std::uint32_t>(topology.folds);
  Strips strips;
  for (const auto& triangle : triangles) {
    std::uint32_t row = triangle[0] / columns, least = columns, most = 0;
    for (const std::uint32_t corner : triangle) {
      row = std::min(row, corner / columns);
      least = std::min(least, corner % columns);
      most = std::max(most, corner % columns);
    }
    // The last link of closed cloth goes from its own column to column 0.
    const bool over_the_seam = most - least > folds;
    std::uint32_t link = least / folds;
    if (over_the_seam) link = columns / folds - 1;
    strips[{row, link}].push_back(triangle);
  }
  return strips;
}

double distanceTo(const Triangles& triangles, const FineMesh& mesh, const Vec3& point) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& t : triangles) {
    const TriangleClosest closest =
        closestOnTriangle(point, mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
    least = std::min(least, closest.distance_squared);
  }
  return std::sqrt(least);
}

/// Largest way of points all over `from` to `to`, as a share of what is allowed there.
double largestShare(const Triangles& from, const Triangles& to, const FineMesh& mesh, const MeshDetail& detail) {
  constexpr int kDivisions = 5;
  double largest = 0.0;
  for (const auto& t : from) {
    for (int i = 0; i <= kDivisions; ++i) {
      for (int j = 0; i + j <= kDivisions; ++j) {
        const Vec3 point =
            (i * mesh.positions[t[0]] + j * mesh.positions[t[1]] + (kDivisions - i - j) * mesh.positions[t[2]]) /
            kDivisions;
        double allowed = detail.tolerance;
        if (detail.viewer) allowed = std::max(allowed, detail.viewer_tolerance * (point - *detail.viewer).norm());
        largest = std::max(largest, distanceTo(to, mesh, point) / allowed);
      }
    }
  }
  return largest;
}

TEST(MeshReducer, IsNoFurtherFromTheFineMeshThanItMayBe) {
  double largest = 0.0;
  for (const Cloth& cloth : cloths()) {
    MeshReducer reducer(cloth.topology);
    const Strips fine = stripsOf(cloth.topology.triangles, cloth.topology);
    for (const MeshDetail& detail : details()) {
      const Triangles& triangles = reducer.reduce(cloth.mesh, detail);
      if (&triangles == &cloth.topology.triangles) continue;
      const Strips reduced = stripsOf(triangles, cloth.topology);
      ASSERT_EQ(reduced.size(), fine.size());
      for (const auto& [place, strip] : fine) {
        const Triangles& drawn = reduced.at(place);
        if (drawn == strip) continue;
        const double share =
            std::max(largestShare(strip, drawn, cloth.mesh, detail), largestShare(drawn, strip, cloth.mesh, detail));
        EXPECT_LE(share, 1.0 + 1e-9) << "strip " << place.first << ", " << place.second;
        largest = std::max(largest, share);
      }
    }
  }
  std::printf("largest way from the fine mesh: %.2f of what is allowed\n", largest);
  EXPECT_GT(largest, 0.3) << "what is allowed is made use of";
}

// A straight link needs its ends alone.
TEST(MeshReducer, TautClothHasTwoTrianglesAQuad) {
  Simulator simulator(curtain_test::flatScene(9, 8));
  FineMesh mesh;
  simulator.copyFineMesh(mesh);
  MeshReducer reducer(simulator.fineMeshTopology());
  EXPECT_EQ(reducer.reduce(mesh, within(1e-6)).size(), 2u * 8u * 7u);
}

// The further away the eye, the less is drawn; from far away, two triangles a quad.
TEST(MeshReducer, DrawsLessFromFurtherAway) {
  const Cloth cloth = shipped("curtain", 6, 40);
  MeshReducer reducer(cloth.topology);
  std::size_t last = cloth.topology.triangles.size() + 1;
  std::printf("curtain, 44 x 40 nodes, 1e-3 rad: fine %zu triangles\n", cloth.topology.triangles.size());
  for (const double distance : {1.0, 2.0, 4.0, 8.0, 16.0, 64.0}) {
    const MeshDetail detail = seenFrom(Vec3(0.3, -distance, 1.2), 1e-3);
    const std::size_t count = reducer.reduce(cloth.mesh, detail).size();
    std::printf("  from %4.0f m: %5zu\n", distance, count);
    curtain_test::keepFigure("triangles from " + std::to_string(static_cast<int>(distance)) + " m",
                             static_cast<double>(count));
    EXPECT_LT(count, last);
    last = count;
  }
  EXPECT_EQ(last, 2u * 43u * 39u);
}

}  // namespace
}  // namespace curtain
