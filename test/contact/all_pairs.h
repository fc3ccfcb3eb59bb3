// SPDX-License-Identifier: BSD-3-Clause
//
// What the broad phase is held against: all pairs of elements of a motion.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "contact/broad_phase/self_candidates.h"
#include "contact/element_distances.h"

namespace curtain_test {

using curtain::Candidates;
using curtain::ClothPattern;
using curtain::CoarseMesh;
using curtain::EdgeEdge;
using curtain::Field3;
using curtain::Grid;
using curtain::MeshEdge;
using curtain::MeshTriangle;
using curtain::Vec3;
using curtain::VertexTriangle;

struct Motion {
  std::string name;
  ClothPattern pattern;
  Field3 start, end;
  double reach;  // [m]
};

using Elements = std::vector<std::uint32_t>;  // an element's nodes, sorted
using ElementPair = std::pair<Elements, Elements>;

inline Elements sorted(Elements nodes) {
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

inline ElementPair pairOf(const VertexTriangle& c) {
  return {{c.vertex}, sorted({c.triangle.begin(), c.triangle.end()})};
}

inline ElementPair pairOf(const EdgeEdge& c) {
  Elements first = sorted({c.first.begin(), c.first.end()}), second = sorted({c.second.begin(), c.second.end()});
  if (second < first) std::swap(first, second);
  return {first, second};
}

/// All pairs of a motion, by the definition.
class Oracle {
 public:
  explicit Oracle(const Motion& motion) : motion_(motion) {}

  /// Says what is wrong with what was named.
  void check(const Candidates& candidates) {
    std::set<ElementPair> named;
    for (const VertexTriangle& c : candidates.vertex_triangles) add(pairOf(c), named);
    for (const EdgeEdge& c : candidates.edge_edges) add(pairOf(c), named);
    const CoarseMesh mesh = makeCoarseMesh(motion_.pattern.grid);
    std::vector<Elements> vertices, edges, triangles;
    for (int i = 0; i < motion_.pattern.grid.rows; ++i) {
      for (int j = 0; j < motion_.pattern.grid.columns; ++j) {
        vertices.push_back({static_cast<std::uint32_t>(motion_.pattern.grid.index(i, j))});
      }
    }
    for (const MeshEdge& edge : mesh.edges) edges.push_back(sorted({edge.begin(), edge.end()}));
    for (const MeshTriangle& t : mesh.triangles) triangles.push_back(sorted({t.begin(), t.end()}));
    std::sort(edges.begin(), edges.end());
    const std::vector<Eigen::AlignedBox3d> edge_boxes = boxesOf(edges), triangle_boxes = boxesOf(triangles);
    const std::vector<Eigen::AlignedBox3d> vertex_boxes = boxesOf(vertices);
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      for (std::size_t t = 0; t < triangles.size(); ++t) {
        compare(vertices[v], triangles[t], gap(vertex_boxes[v], triangle_boxes[t]), named);
      }
    }
    for (std::size_t e = 0; e < edges.size(); ++e) {
      for (std::size_t f = e + 1; f < edges.size(); ++f)
        compare(edges[e], edges[f], gap(edge_boxes[e], edge_boxes[f]), named);
    }
    EXPECT_TRUE(named.empty()) << motion_.name << ": " << named.size() << " pairs that are not in the mesh";
  }

  int left_out = 0;  ///< pairs whose boxes are within reach

 private:
  void add(ElementPair pair, std::set<ElementPair>& named) const {
    const Grid& grid = motion_.pattern.grid;
    const bool may_be_twice = grid.closed && grid.columns <= 4;
    EXPECT_TRUE(named.insert(std::move(pair)).second || may_be_twice) << motion_.name << ": twice";
  }

  std::vector<Eigen::AlignedBox3d> boxesOf(const std::vector<Elements>& elements) const {
    std::vector<Eigen::AlignedBox3d> boxes(elements.size());
    for (std::size_t k = 0; k < elements.size(); ++k) {
      for (const std::uint32_t n : elements[k]) boxes[k].extend(motion_.start.at(n)).extend(motion_.end.at(n));
    }
    return boxes;
  }

  static double gap(const Eigen::AlignedBox3d& one, const Eigen::AlignedBox3d& other) {
    return (one.min() - other.max()).cwiseMax(other.min() - one.max()).maxCoeff();
  }

  void compare(const Elements& one, const Elements& other, double gap, std::set<ElementPair>& named) {
    const bool was_named = named.erase({one, other}) > 0;
    const auto immovable = [&](std::uint32_t n) { return motion_.pattern.inverse_mass[n] == 0.0; };
    const bool dropped =
        std::all_of(one.begin(), one.end(), immovable) && std::all_of(other.begin(), other.end(), immovable);
    const auto is_shared = [&](std::uint32_t n) { return std::count(other.begin(), other.end(), n) > 0; };
    const bool shared = std::any_of(one.begin(), one.end(), is_shared);
    if (was_named) {
      EXPECT_FALSE(shared || dropped) << motion_.name;
    }
    if (was_named || shared || dropped || gap > motion_.reach) return;
    ++left_out;
    EXPECT_GT(minDistance(one, other), motion_.reach) << motion_.name << ": missed " << one[0] << " " << other[0];
  }

  double minDistance(const Elements& one, const Elements& other) const {
    constexpr int kInstants = 16;
    double least = 1e300;
    for (int k = 0; k <= kInstants; ++k) {
      const double t = static_cast<double>(k) / kInstants;
      const auto at = [&](std::uint32_t n) -> Vec3 { return (1.0 - t) * motion_.start.at(n) + t * motion_.end.at(n); };
      if (one.size() == 1) {
        least = std::min(least, distanceToTriangle(at(one[0]), at(other[0]), at(other[1]), at(other[2])));
      } else {
        least = std::min(least, distanceOfSegments(at(one[0]), at(one[1]), at(other[0]), at(other[1])));
      }
    }
    return least;
  }

  const Motion motion_;
};

}  // namespace curtain_test
