// SPDX-License-Identifier: BSD-3-Clause
//
// Which pairs of elements become contacts, against all pairs of the mesh.
#include "contact/response/self_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::Random;
using curtain_test::shake;

constexpr double kGap = 0.006, kLink = 0.02;

// Two layers of one cloth, the hem folded up to the top, `apart` [m] from each other and rough by `rough` [m].
struct Folded {
  Folded(double apart, double rough, std::uint64_t seed) {
    Scene scene = flatScene(14, 9, 13 * kLink, 8 * kLink);
    scene.pins.kind = PinKind::kNone;
    pattern = makePattern(scene);
    const Grid& grid = pattern.grid;
    position.assign(grid.size(), 0.0);
    for (int i = 0; i < grid.rows; ++i) {
      for (int j = 0; j < grid.columns; ++j) {
        const bool up = i >= grid.rows / 2;
        // Nodes of one layer lie over rows and edges of the other one, and beside them.
        const double shift = static_cast<double>(seed % 3) / 2.0;
        position.set(grid.index(i, j), {kLink * (j + (up ? 0.5 * shift : 0.0)), up ? apart : 0.0,
                                        -kLink * (up ? grid.rows - 1 - i + shift : i)});
      }
    }
    shake(pattern, rough, seed, position);
  }

  // All pairs that share no node.
  Candidates allPairs() const {
    const CoarseMesh mesh = makeCoarseMesh(pattern.grid);
    Candidates all;
    for (int i = 0; i < pattern.grid.rows; ++i) {
      for (int j = 0; j < pattern.grid.columns; ++j) {
        const auto vertex = static_cast<std::uint32_t>(pattern.grid.index(i, j));
        for (const MeshTriangle& t : mesh.triangles) {
          if (std::find(t.begin(), t.end(), vertex) == t.end()) all.add(VertexTriangle{vertex, t});
        }
      }
    }
    return all;
  }

  ClothPattern pattern;
  Field3 position;
};

Contacts collected(const Folded& cloth, const Candidates& candidates) {
  SelfContacts self(cloth.pattern, kGap, ContactParams{});
  Contacts contacts;
  contacts.reserve(4096);
  self.collect(candidates, {}, cloth.position, cloth.position, 0.002, contacts);
  return contacts;
}

// A vertex over the border of triangles touches all of them there. One contact is enough: those at the least distances
// from the surface, seen from triangle to triangle across their borders.
TEST(SelfContacts, AreWhereTheDistanceToTheSurfaceIsLeast) {
  int left_out = 0, kept = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Folded cloth(0.004, seed < 6 ? 0.0 : 0.004, seed);
    const auto at = [&](std::uint32_t n) { return cloth.position.at(n); };
    struct Touching {
      MeshTriangle triangle;
      ClosestPoints closest;
      bool kept;
    };
    std::map<std::uint32_t, std::vector<Touching>> touching;
    const Contacts contacts = collected(cloth, cloth.allPairs());
    for (const VertexTriangle& pair : cloth.allPairs().vertex_triangles) {
      const MeshTriangle& t = pair.triangle;
      const ClosestPoints closest = closestPoints(false, {at(pair.vertex), at(t[0]), at(t[1]), at(t[2])});
      if (closest.distance >= kGap) continue;
      const bool is_kept = std::any_of(contacts.begin(), contacts.end(), [&](const Contact& contact) {
        return contact.node == std::array<std::uint32_t, 4>{pair.vertex, t[0], t[1], t[2]};
      });
      touching[pair.vertex].push_back({t, closest, is_kept});
      (is_kept ? kept : left_out) += 1;
    }
    for (const auto& [vertex, of_vertex] : touching) {
      const auto least = std::min_element(of_vertex.begin(), of_vertex.end(), [](const Touching& a, const Touching& b) {
        return a.closest.distance < b.closest.distance;
      });
      EXPECT_TRUE(std::any_of(
          of_vertex.begin(), of_vertex.end(),
          [&](const Touching& other) { return other.kept && other.closest.distance == least->closest.distance; }))
          << "vertex " << vertex << ", seed " << seed;
      for (const Touching& its : of_vertex) {
        const auto tells = [&](const Touching& other) {
          if (other.triangle == its.triangle || other.closest.distance > its.closest.distance) return false;
          for (std::size_t n = 0; n < 3; ++n) {
            const bool there =
                std::find(other.triangle.begin(), other.triangle.end(), its.triangle[n]) != other.triangle.end();
            if (its.closest.weight[n + 1] != 0.0 && !there) return false;
          }
          return true;
        };
        EXPECT_TRUE(its.kept || std::any_of(of_vertex.begin(), of_vertex.end(), tells))
            << "vertex " << vertex << ", seed " << seed;
      }
    }
  }
  EXPECT_GT(kept, 1000);
  EXPECT_GT(left_out, 1000);
}

TEST(SelfContacts, AreTheSameInWhateverOrderPairsAreFound) {
  const Folded cloth(0.004, 0.003, 4);
  Candidates all = cloth.allPairs();
  const Contacts contacts = collected(cloth, all);
  std::reverse(all.vertex_triangles.begin(), all.vertex_triangles.end());
  const Contacts others = collected(cloth, all);
  ASSERT_EQ(contacts.size(), others.size());
  ASSERT_FALSE(contacts.empty());
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    EXPECT_EQ(contacts[k].node, others[k].node);
    EXPECT_EQ(contacts[k].weight, others[k].weight);
  }
}

}  // namespace
}  // namespace curtain
