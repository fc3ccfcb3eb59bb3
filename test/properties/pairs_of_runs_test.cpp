// SPDX-License-Identifier: BSD-3-Clause
//
// The look for pairs against brute force on ways that cloth really goes: every pair of elements that comes within the
// gap at one of eight times of a way is named. CURTAIN_PROPERTY_SEEDS: so many hundreds of pairs in each scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "cloth/coarse_mesh.h"
#include "contact/broad_phase/self_candidates.h"
#include "contact/narrow_phase/closest_points.h"
#include "curtain_sim/scene_yaml.h"
#include "curtain_sim/simulator.h"
#include "properties/seeds.h"
#include "testing.h"

namespace curtain {
namespace {

constexpr int kInstants = 8;

/// A vertex and a triangle, or two edges; nodes in order, the lower edge first.
using Key = std::array<std::uint32_t, 4>;

Key keyOf(std::uint32_t vertex, MeshTriangle triangle) {
  std::sort(triangle.begin(), triangle.end());
  return {vertex, triangle[0], triangle[1], triangle[2]};
}

Key keyOf(MeshEdge one, MeshEdge other) {
  std::sort(one.begin(), one.end());
  std::sort(other.begin(), other.end());
  if (other < one) std::swap(one, other);
  return {one[0], one[1], other[0], other[1]};
}

/// An element's nodes and the box around its way.
struct Element {
  std::array<std::uint32_t, 3> node;
  int nodes;
  Eigen::AlignedBox3d box;
};

/// All elements of a way, by where their boxes begin along x.
std::vector<Element> elementsOf(const std::vector<Element>& kinds, const Field3& start, const Field3& end) {
  std::vector<Element> elements = kinds;
  for (Element& element : elements) {
    element.box.setEmpty();
    for (int k = 0; k < element.nodes; ++k) {
      const std::uint32_t n = element.node[static_cast<std::size_t>(k)];
      element.box.extend(start.at(n)).extend(end.at(n));
    }
  }
  std::sort(elements.begin(), elements.end(),
            [](const Element& a, const Element& b) { return a.box.min().x() < b.box.min().x(); });
  return elements;
}

bool shareNode(const Element& a, const Element& b) {
  return std::any_of(a.node.begin(), a.node.begin() + a.nodes, [&](std::uint32_t n) {
    return std::find(b.node.begin(), b.node.begin() + b.nodes, n) != b.node.begin() + b.nodes;
  });
}

class WatchedRun {
 public:
  explicit WatchedRun(const Scene& scene)
      : pattern_(makePattern(scene)),
        simulator_(scene),
        gap_(std::min(scene.contact.thickness,
                      0.25 * std::min(shortest(pattern_.warp_rest), shortest(pattern_.weft_rest)))),
        pairs_(pattern_) {
    const Grid& grid = pattern_.grid;
    for (int i = 0; i < grid.rows; ++i) {
      for (int j = 0; j < grid.columns; ++j) {
        vertices_.push_back({{static_cast<std::uint32_t>(grid.index(i, j)), 0, 0}, 1, {}});
      }
    }
    const CoarseMesh mesh = makeCoarseMesh(grid);
    for (const MeshEdge& edge : mesh.edges) edges_.push_back({{edge[0], edge[1], 0}, 2, {}});
    for (const MeshTriangle& triangle : mesh.triangles) triangles_.push_back({triangle, 3, {}});
    take(now_);
  }

  /// Goes on, and looks at the way of a quarter of a frame, which is that of a substep, about.
  void goOn(int frames) {
    for (int frame = 0; frame + 1 < frames; ++frame) simulator_.step();
    take(now_);
    simulator_.step();
    Field3 end;
    take(end);
    for (std::size_t n = 0; n < end.x.size(); ++n) end.set(n, now_.at(n) + 0.25 * (end.at(n) - now_.at(n)));
    Candidates candidates;
    pairs_.collect(now_, end, gap_, candidates);
    named_.clear();
    for (const VertexTriangle& c : candidates.vertex_triangles) named_.insert(keyOf(c.vertex, c.triangle));
    for (const EdgeEdge& c : candidates.edge_edges) named_.insert(keyOf(c.first, c.second));
    compare(elementsOf(vertices_, now_, end), elementsOf(triangles_, now_, end), end);
    const std::vector<Element> edges = elementsOf(edges_, now_, end);
    compare(edges, edges, end);
  }

  int within = 0, missed = 0;

 private:
  static double shortest(const Field& rest) {
    double least = 1e300;
    for (const double one : rest) least = one > 0.0 ? std::min(least, one) : least;
    return least;
  }

  void take(Field3& out) const {
    std::vector<Vec3> positions;
    simulator_.copyPositions(positions);
    out.assign(pattern_.grid.size(), 0.0);
    for (int i = 0; i < pattern_.grid.rows; ++i) {
      for (int j = 0; j < pattern_.grid.columns; ++j)
        out.set(pattern_.grid.index(i, j), positions[static_cast<std::size_t>(i * pattern_.grid.columns + j)]);
    }
  }

  void compare(const std::vector<Element>& ones, const std::vector<Element>& others, const Field3& end) {
    const bool edges = &ones == &others;
    double widest = 0.0;
    for (const Element& other : others) widest = std::max(widest, other.box.sizes().x());
    for (std::size_t k = 0; k < ones.size(); ++k) {
      const Element& one = ones[k];
      const auto first = std::lower_bound(others.begin(), others.end(), one.box.min().x() - gap_ - widest,
                                          [](const Element& e, double x) { return e.box.min().x() < x; });
      for (auto other = edges ? others.begin() + static_cast<std::ptrdiff_t>(k) + 1 : first;
           other != others.end() && other->box.min().x() <= one.box.max().x() + gap_; ++other) {
        const double apart = (one.box.min() - other->box.max()).cwiseMax(other->box.min() - one.box.max()).maxCoeff();
        if (apart > gap_ || shareNode(one, *other) || !comesWithin(one, *other, end)) continue;
        ++within;
        const Key key = edges ? keyOf(MeshEdge{one.node[0], one.node[1]}, MeshEdge{other->node[0], other->node[1]})
                              : keyOf(one.node[0], other->node);
        missed += named_.count(key) == 0;
      }
    }
  }

  bool comesWithin(const Element& one, const Element& other, const Field3& end) const {
    bool moves = false;
    for (int k = 0; k < one.nodes; ++k)
      moves = moves || pattern_.inverse_mass[one.node[static_cast<std::size_t>(k)]] > 0.0;
    for (int k = 0; k < other.nodes; ++k)
      moves = moves || pattern_.inverse_mass[other.node[static_cast<std::size_t>(k)]] > 0.0;
    for (int k = 0; moves && k < kInstants; ++k) {
      const double t = static_cast<double>(k) / (kInstants - 1);
      const auto at = [&](std::uint32_t n) -> Vec3 { return now_.at(n) + t * (end.at(n) - now_.at(n)); };
      const auto &p = one.node, &q = other.node;
      const double square = one.nodes == 1 ? closestOnTriangle(at(p[0]), at(q[0]), at(q[1]), at(q[2])).distance_squared
                                           : closestOnSegments(at(p[0]), at(p[1]), at(q[0]), at(q[1])).distance_squared;
      if (square <= gap_ * gap_) return true;
    }
    return false;
  }

  ClothPattern pattern_;
  Simulator simulator_;
  double gap_;
  SelfCandidates pairs_;
  std::vector<Element> vertices_, edges_, triangles_;
  Field3 now_;
  std::set<Key> named_;
};

Scene heap() {
  Scene scene = curtain_test::flatScene(24, 22, 1.1);
  scene.pins.kind = PinKind::kNone;
  scene.air.inside = scene.air.border = scene.air.corner = 0.3;
  scene.contact.self = true;
  ObstacleParams floor;
  floor.name = "floor";
  floor.shape = ShapeKind::kPlane;
  scene.obstacles.push_back(floor);
  return scene;
}

class PairsOfRuns : public testing::TestWithParam<std::string> {};

TEST_P(PairsOfRuns, AreAllNamed) {
  Scene scene = heap();
  if (GetParam() != "heap") {
    const SceneReading reading =
        readSceneFile(std::string(CURTAIN_SOURCE_DIR "/config/scenes/") + GetParam() + ".yaml");
    ASSERT_TRUE(reading.problems.empty());
    scene = reading.scene;
  }
  scene.solver.rest_speed = 0.0;
  const int wanted = 100 * static_cast<int>(curtain_test::numberFromEnvironment("CURTAIN_PROPERTY_SEEDS", 10));
  WatchedRun run(scene);
  run.goOn(60);
  for (int looks = 0; run.within < wanted && looks < 2000; ++looks) run.goOn(5);
  std::printf("%s: %d pairs come within the gap, %d missed\n", GetParam().c_str(), run.within, run.missed);
  EXPECT_GE(run.within, 1000);
  EXPECT_EQ(run.missed, 0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, PairsOfRuns, testing::Values("curtain", "flag", "sheet", "skirt", "heap"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace curtain
