// SPDX-License-Identifier: BSD-3-Clause
//
// The broad phase against all pairs of elements: it names each pair once that comes within reach, only pairs of the
// mesh, and none of flat and gently pleated cloth.
#include "contact/broad_phase/self_candidates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>

#include "contact/all_pairs.h"
#include "count_allocations.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::ElementPair;
using curtain_test::Elements;
using curtain_test::flatScene;
using curtain_test::kPi;
using curtain_test::Motion;
using curtain_test::Oracle;
using curtain_test::pairOf;
using curtain_test::Random;
using curtain_test::randomPositions;
using curtain_test::ringScene;
using curtain_test::shake;
using curtain_test::sorted;

using Place = std::function<Vec3(int i, int j)>;

Field3 placed(const Grid& grid, const Place& place) {
  Field3 position;
  position.assign(grid.size(), 0.0);
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) position.set(grid.index(i, j), place(i, j));
  }
  return position;
}

/// Free cloth with links of `link` [m].
ClothPattern squareCloth(int rows, int columns, double link = 0.025, bool closed = false) {
  Scene scene = flatScene(rows, columns, link * (rows - 1), link * (closed ? columns : columns - 1));
  scene.cloth.closed = closed;
  scene.pins.kind = PinKind::kNone;
  return makePattern(scene);
}

Field3 flat(const Grid& grid, double link = 0.025) {
  return placed(grid, [&](int i, int j) { return Vec3(j * link, 0.0, -i * link); });
}

Field3 rotated(Field3 position, double angle, const Vec3& away = Vec3::Zero()) {
  const Eigen::AngleAxisd turn(angle, Vec3(1.0, 2.0, 3.0).normalized());
  for (std::size_t n = 0; n < position.x.size(); ++n) position.set(n, turn * position.at(n) + away);
  return position;
}

/// Folded back and forth along columns by chance, layers 4 to 8 mm apart, and along rows.
Field3 heap(const Grid& grid, std::uint64_t seed, double link = 0.025) {
  Random random(seed);
  std::vector<Vec3> across, down;
  const auto walk = [&](std::vector<Vec3>& way, int count, const Vec3& along, double jump) {
    Vec3 at = Vec3::Zero();
    double side = 1.0;
    for (int k = 0; k < count; ++k) {
      way.push_back(at);
      const bool turn = random.between(0.0, 1.0) < 0.25;
      if (turn) side = -side;
      at += turn ? Vec3(random.between(0.5, 1.0) * jump * Vec3::UnitY()) : Vec3(side * link * along);
    }
  };
  walk(across, grid.columns, Vec3::UnitX(), 0.008);
  walk(down, grid.rows, Vec3::UnitZ(), 0.04);
  return placed(grid, [&](int i, int j) -> Vec3 {
    return across[static_cast<std::size_t>(j)] + down[static_cast<std::size_t>(i)] + random.inBox(0.001);
  });
}

/// Weft links of constant length whose direction swings by +- `swing` [rad] with a period of 16 columns.
Field3 pleats(const Grid& grid, double swing, double shift, double link = 0.025) {
  std::vector<Vec3> profile(1, Vec3::Zero());
  for (int j = 0; j + 1 < grid.columns; ++j) {
    const double angle = swing * std::sin(2.0 * kPi * (j + shift) / 16.0);
    profile.push_back(profile.back() + link * Vec3(std::cos(angle), std::sin(angle), 0.0));
  }
  return placed(grid, [&](int i, int j) -> Vec3 {
    return profile[static_cast<std::size_t>(j)] + Vec3(0.0, 0.003 * std::sin(0.4 * i + shift), -i * link);
  });
}

template <typename Pair>
std::multiset<ElementPair> named(const std::vector<Pair>& pairs) {
  std::multiset<ElementPair> all;
  for (const Pair& pair : pairs) all.insert(pairOf(pair));
  return all;
}

/// Candidates of the motion, held against the oracle and against those that several threads find.
Candidates checked(const Motion& motion, int* left_out = nullptr) {
  SelfCandidates pairs(motion.pattern);
  Candidates candidates;
  pairs.collect(motion.start, motion.end, motion.reach, candidates);
  const Workers workers(3);
  const Workers::Shift standing_by(workers);
  Candidates by_several;
  SelfCandidates(motion.pattern, &workers).collect(motion.start, motion.end, motion.reach, by_several);
  EXPECT_EQ(named(by_several.vertex_triangles), named(candidates.vertex_triangles)) << motion.name;
  EXPECT_EQ(named(by_several.edge_edges), named(candidates.edge_edges)) << motion.name;
  Oracle oracle(motion);
  oracle.check(candidates);
  if (left_out != nullptr) *left_out = oracle.left_out;
  return candidates;
}

template <typename Pair>
std::vector<Pair> withoutDoubles(const std::vector<Pair>& pairs) {
  std::set<ElementPair> known;
  std::vector<Pair> once;
  for (const Pair& pair : pairs) {
    if (known.insert(pairOf(pair)).second) once.push_back(pair);
  }
  return once;
}

Candidates withoutDoubles(const Candidates& candidates) {
  Candidates once;
  once.vertex_triangles = withoutDoubles(candidates.vertex_triangles);
  once.edge_edges = withoutDoubles(candidates.edge_edges);
  return once;
}

bool isEmpty(const Candidates& c) { return c.vertex_triangles.empty() && c.edge_edges.empty(); }

Field3 moved(const ClothPattern& pattern, Field3 position, double size, std::uint64_t seed) {
  shake(pattern, size, seed, position);
  return position;
}

TEST(SelfCandidates, NamesNothingOnFlatClothHoweverItMovesAsAWhole) {
  const ClothPattern pattern = squareCloth(20, 17);
  const Field3 cloth = flat(pattern.grid);
  for (const double angle : {0.0, 0.4, 1.1, 2.0}) {
    int left_out = 0;
    const Motion motion{"flat", pattern, rotated(cloth, angle), rotated(cloth, angle + 0.1, {0.3, 0.2, 0.1}), 0.006};
    EXPECT_TRUE(isEmpty(checked(motion, &left_out))) << angle;
    EXPECT_GT(left_out, 1000) << "the boxes alone would not do";
  }
}

TEST(SelfCandidates, NamesNothingOnGentlyPleatedCloth) {
  const ClothPattern pattern = squareCloth(14, 40);
  for (const double swing : {0.4, 0.8, 1.1}) {
    for (const double angle : {0.0, 0.3, 1.0}) {
      const Motion motion{"pleated", pattern, rotated(pleats(pattern.grid, swing, 0.0), angle),
                          rotated(pleats(pattern.grid, swing, 0.2), angle), 0.006};
      EXPECT_TRUE(isEmpty(checked(motion))) << swing << ", " << angle;
    }
  }
}

TEST(SelfCandidates, MissesNoPairOfDeepPleats) {
  const ClothPattern pattern = squareCloth(10, 40);
  for (const double swing : {1.4, 1.7, 2.0, 2.3, 2.6}) {
    for (const double angle : {0.0, 0.7}) {
      checked({"deep pleats", pattern, rotated(pleats(pattern.grid, swing, 0.0), angle),
               rotated(pleats(pattern.grid, swing, 0.7), angle), 0.006});
    }
  }
}

// Even everywhere, and one turn lies on the next.
TEST(SelfCandidates, MissesNoPairOfAScroll) {
  const ClothPattern pattern = squareCloth(100, 9);
  for (const double angle : {0.0, 0.6}) {
    const Field3 scroll = rotated(placed(pattern.grid,
                                         [](int i, int j) {
                                           const double turn = 0.025 * i / 0.3,
                                                        radius = 0.3 + 0.004 * turn / (2.0 * kPi);
                                           return Vec3(0.025 * j, radius * std::cos(turn), radius * std::sin(turn));
                                         }),
                                  angle);
    EXPECT_FALSE(isEmpty(checked({"scroll", pattern, scroll, scroll, 0.006})));
  }
}

// Three layers of eight quads, drifting apart by 6 mm a layer, along the warp or along the weft alone. The first and
// the third are flat alike and only what lies between them is not.
TEST(SelfCandidates, MissesNoPairOfClothFoldedInThree) {
  const auto along = [](int k) { return 0.025 * (k <= 8 ? k : k <= 16 ? 16 - k : k - 16); };
  for (const bool by_rows : {false, true}) {
    const ClothPattern pattern = by_rows ? squareCloth(25, 9) : squareCloth(9, 25);
    const Field3 folded = placed(pattern.grid, [&](int i, int j) {
      return by_rows ? Vec3(0.025 * j, 0.00075 * i, -along(i)) : Vec3(along(j), 0.00075 * j, -0.025 * i);
    });
    const Field3 open = flat(pattern.grid);
    for (const double angle : {0.0, 0.3}) {
      const Field3 turned = rotated(folded, angle), turned_open = rotated(open, angle);
      EXPECT_FALSE(isEmpty(checked({"folded", pattern, turned, turned, 0.015})));
      EXPECT_FALSE(isEmpty(checked({"folding", pattern, turned_open, turned, 0.015})));
      EXPECT_FALSE(isEmpty(checked({"unfolding", pattern, turned, turned_open, 0.015})));
    }
  }
}

TEST(SelfCandidates, MissesNoPairOfAHeap) {
  const ClothPattern pattern = squareCloth(18, 22);
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Field3 cloth = rotated(heap(pattern.grid, seed), 0.3 * static_cast<double>(seed - 1));
    const Candidates candidates = checked({"heap", pattern, cloth, moved(pattern, cloth, 0.003, seed), 0.006});
    EXPECT_GT(candidates.vertex_triangles.size(), 500u);
    EXPECT_GT(candidates.edge_edges.size(), 500u);
  }
}

// Columns cut off from both neighbours, cuts side by side, through all rows and from some row on, next to the seam.
TEST(SelfCandidates, NamesJustThePairsOfTheStripsOfCutCloth) {
  for (const bool closed : {false, true}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      ClothPattern pattern = squareCloth(13, 18, 0.025, closed);
      Random random(seed);
      pattern.grid.slit_row.assign(18, 13);
      for (int& row : pattern.grid.slit_row) {
        if (random.between(0.0, 1.0) < 0.4) row = static_cast<int>(random.between(-6.0, 13.0) > 0.0 ? row / 2 : 0);
      }
      const Field3 cloth = heap(pattern.grid, seed);
      EXPECT_FALSE(isEmpty(checked({"cut heap", pattern, cloth, moved(pattern, cloth, 0.003, seed), 0.006})));
    }
  }
}

// Cloths of two columns and more side by side in the grid, each a heap, one through the other.
TEST(SelfCandidates, NamesJustThePairsOfClothsInOneGrid) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Random random(seed);
    std::vector<int> first;  // columns of the cloths
    int columns = 0;
    for (int k = 0; k < 5; ++k) {
      first.push_back(columns);
      columns += 2 + static_cast<int>(random.between(0.0, k == 2 ? 1.0 : 9.0));
    }
    ClothPattern pattern = squareCloth(11, columns, 0.025, false);
    pattern.grid.slit_row.assign(static_cast<std::size_t>(columns), 11);
    for (std::size_t k = 1; k < first.size(); ++k) pattern.grid.slit_row[static_cast<std::size_t>(first[k])] = 0;
    Field3 cloth = heap(pattern.grid, seed);
    for (const int column : first) {
      const Vec3 at = cloth.at(pattern.grid.index(0, column)), to = random.inBox(0.02);
      for (int i = 0; i < 11; ++i) {
        for (int j = column; j < columns; ++j) cloth.add(pattern.grid.index(i, j), to - at);
      }
    }
    EXPECT_FALSE(isEmpty(checked({"cloths", pattern, cloth, moved(pattern, cloth, 0.003, seed), 0.006})));
  }
}

TEST(SelfCandidates, MissesNoPairOfAnyShapeOfGrid) {
  for (const auto& [rows, columns] :
       std::vector<std::pair<int, int>>{{2, 2}, {2, 3}, {3, 2}, {2, 50}, {50, 2}, {9, 10}, {17, 9}}) {
    const ClothPattern pattern = squareCloth(rows, columns);
    const Field3 cloth = rotated(flat(pattern.grid), 0.5);
    EXPECT_TRUE(isEmpty(checked({"flat grid", pattern, cloth, cloth, 0.006}))) << rows << " x " << columns;
    checked({"heap grid", pattern, heap(pattern.grid, 3), moved(pattern, heap(pattern.grid, 3), 0.01, 1), 0.006});
    checked({"rough grid", pattern, cloth, moved(pattern, cloth, 0.02, 2), 0.01});
  }
}

// Between the certified and the crumpled: where a wrong bound shows.
TEST(SelfCandidates, MissesNoPairOfRoughCloth) {
  Random random(11);
  int left_out = 0, candidates = 0;
  for (int round = 0; round < 60; ++round) {
    const ClothPattern pattern = squareCloth(9, 11);
    const auto seed = static_cast<std::uint64_t>(round);
    const double size = random.between(0.001, 0.02);
    const double shear = random.between(-1.0, 1.0), squeeze = random.between(0.3, 1.5);
    const Field3 cloth =
        placed(pattern.grid, [&](int i, int j) { return Vec3(0.025 * (j * squeeze + i * shear), 0.0, -0.025 * i); });
    const Field3 start = rotated(moved(pattern, cloth, size, seed), random.between(0.0, 3.0));
    const Motion motion{"rough", pattern, start, moved(pattern, start, size, seed + 100), random.between(0.002, 0.015)};
    int left = 0;
    const Candidates found = checked(motion, &left);
    left_out += left;
    candidates += static_cast<int>(found.edge_edges.size());
  }
  EXPECT_GT(left_out, 300);
  EXPECT_GT(candidates, 1000);
}

// Boxes of long quads that lie slantwise meet by the thousand.
TEST(SelfCandidates, FindsRoomForPairsOfLongQuads) {
  const ClothPattern pattern = squareCloth(80, 4, 0.02);
  const Vec3 along = Vec3(1.0, 1.0, 1.0).normalized(), down = Vec3(1.0, -1.0, 0.0).normalized();
  const Field3 cloth = placed(pattern.grid, [&](int i, int j) -> Vec3 { return 0.7 * j * along + 0.012 * i * down; });
  SelfCandidates pairs(pattern);
  Candidates candidates;
  pairs.reserve(candidates);
  pairs.collect(cloth, cloth, 0.02, candidates);
  EXPECT_FALSE(candidates.full);
  EXPECT_FALSE(candidates.edge_edges.empty());
  const Motion motion{"long quads", pattern, cloth, cloth, 0.02};
  Oracle(motion).check(candidates);
}

TEST(SelfCandidates, MissesNoPairOfRandomClouds) {
  Random random(7);
  for (const bool closed : {false, true}) {
    const ClothPattern pattern = squareCloth(9, 12, 0.025, closed);
    for (const double size : {0.02, 0.1, 0.5}) {
      const Field3 start = randomPositions(pattern.grid, random, size);
      checked({"cloud", pattern, start, moved(pattern, start, 0.02, 4), 0.006});
    }
  }
}

TEST(SelfCandidates, MissesNoPairOfTaperedClothWithUnequalSpacings) {
  Scene scene = flatScene(17, 14, 0.5, 0.4);
  scene.pins.kind = PinKind::kNone;
  for (const double hem : {0.15, 0.4, 0.6}) {
    scene.cloth.hem_width = hem;
    scene.cloth.row_spacing.clear();
    scene.cloth.column_spacing.clear();
    for (const bool even : {true, false}) {
      if (!even) {
        for (int i = 0; i < 16; ++i) scene.cloth.row_spacing.push_back(1.0 + i % 3);
        for (int j = 0; j < 13; ++j) scene.cloth.column_spacing.push_back(1.0 + (j * j) % 5);
      }
      const ClothPattern pattern = makePattern(scene);
      const Field3 cloth = rotated(makeInitialState(scene, pattern).position, 0.6);
      const Candidates still = checked({"tapered", pattern, cloth, cloth, 0.001});
      EXPECT_TRUE(isEmpty(still)) << hem;
      // Between the narrowest and the widest columns: flatness must not take one for the other.
      for (const double reach : {0.004, 0.008, 0.016}) checked({"narrow columns", pattern, cloth, cloth, reach});
      checked({"tapered, rough", pattern, moved(pattern, cloth, 0.01, 1), moved(pattern, cloth, 0.01, 2), 0.006});
      checked({"tapered, in a heap", pattern, heap(pattern.grid, 5), heap(pattern.grid, 6), 0.006});
    }
  }
}

TEST(SelfCandidates, MissesNoPairOfClosedCloth) {
  for (const int columns : {3, 4, 8, 9, 30}) {
    const ClothPattern pattern = squareCloth(12, columns, 0.025, true);
    const double radius = 0.0125 / std::sin(kPi / columns);
    const auto ring = [&](double squeeze) {
      return placed(pattern.grid, [&](int i, int j) {
        const double angle = 2.0 * kPi * j / columns;
        return Vec3(radius * std::cos(angle), squeeze * radius * std::sin(angle), -0.025 * i);
      });
    };
    const Candidates round = checked({"ring", pattern, ring(1.0), ring(0.9), 0.006});
    if (columns == 30) {
      EXPECT_TRUE(isEmpty(round));
    }
    for (const double squeeze : {0.5, 0.1, 0.02})
      checked({"squeezed ring", pattern, ring(squeeze), ring(-0.5 * squeeze), 0.006});
    checked({"ring in a heap", pattern, heap(pattern.grid, 2), moved(pattern, heap(pattern.grid, 2), 0.01, 3), 0.006});
  }
}

TEST(SelfCandidates, DropsPairsThatCannotMove) {
  Scene scene = flatScene(12, 12, 0.3, 0.3);
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 3; ++j) scene.pins.nodes.push_back({i, j});  // whole triangles
  }
  for (const PinKind kind : {PinKind::kTop, PinKind::kLeft, PinKind::kList}) {
    scene.pins.kind = kind;
    const ClothPattern pattern = makePattern(scene);
    const Field3 cloth =
        placed(pattern.grid, [](int i, int j) { return Vec3(0.004 * j, 0.001 * ((i * j) % 5), 0.004 * i); });
    const Candidates found = checked({"pinned", pattern, cloth, cloth, 0.01});
    EXPECT_FALSE(isEmpty(found));
  }
}

TEST(SelfCandidates, FarFromTheOriginItIsTheSame) {
  const ClothPattern pattern = squareCloth(18, 22);
  const Field3 pleated = pleats(pattern.grid, 0.8, 0.0);
  EXPECT_TRUE(isEmpty(checked(
      {"far", pattern, rotated(pleated, 0.3, {5e5, -6e6, 100.0}), rotated(pleated, 0.35, {5e5, -6e6, 100.0}), 0.006})));
}

std::vector<ElementPair> inOrder(const Candidates& candidates) {
  std::vector<ElementPair> pairs;
  for (const VertexTriangle& c : candidates.vertex_triangles) pairs.push_back(pairOf(c));
  for (const EdgeEdge& c : candidates.edge_edges) pairs.push_back(pairOf(c));
  return pairs;
}

TEST(SelfCandidates, UsedAreAsFreshAndAllocateNothing) {
  const ClothPattern pattern = squareCloth(30, 26);
  const Field3 first = heap(pattern.grid, 1), second = heap(pattern.grid, 2), third = flat(pattern.grid);
  SelfCandidates used(pattern);
  Candidates candidates;
  candidates.reserve(1000 * pattern.grid.nodeCount());  // from heap to heap all meet
  const long warm = allocations;
  const auto collect = [&](const Field3& start, const Field3& end) {
    candidates.clear();
    used.collect(start, end, 0.006, candidates);
  };
  collect(first, first);
  collect(third, third);
  collect(second, third);
  collect(first, second);
  EXPECT_EQ(allocations, warm);
  SelfCandidates fresh(pattern);
  Candidates expected;
  fresh.collect(first, second, 0.006, expected);
  EXPECT_FALSE(isEmpty(expected));
  EXPECT_EQ(inOrder(expected), inOrder(candidates));
}

// Most of what the axes' boxes let through is far away: tilted layers 10 mm apart, and cloth that is swept along as a
// whole.
TEST(SelfCandidates, NamesNoPairOfTiltedLayersThatStayApart) {
  const ClothPattern pattern = squareCloth(24, 9);
  const Field3 folded = placed(pattern.grid, [](int i, int j) {
    // Two layers joined by a wide bow.
    if (i < 10) return Vec3(0.025 * j, 0.0, -0.025 * i);
    if (i < 14) return Vec3(0.025 * j, 0.0025 * (i - 9), -0.225 - 0.02 * std::sin(kPi * (i - 9) / 5.0));
    return Vec3(0.025 * j, 0.0125, -0.025 * (23 - i));
  });
  for (const double angle : {0.0, 0.4, 1.1}) {
    for (const Vec3& along : {Vec3(0.0, 0.0, 0.0), Vec3(0.02, 0.03, -0.01)}) {
      const Field3 start = rotated(folded, angle), end = rotated(folded, angle, along);
      const Candidates found = checked({"layers", pattern, start, end, 0.006});
      int across = 0;
      for (const VertexTriangle& c : found.vertex_triangles) {
        const auto row = static_cast<int>(c.vertex) / pattern.grid.stride;
        across += row < 8 || row > 15 ? 1 : 0;
      }
      for (const EdgeEdge& c : found.edge_edges) {
        const auto row = static_cast<int>(c.first[0]) / pattern.grid.stride;
        across += row < 8 || row > 15 ? 1 : 0;
      }
      EXPECT_EQ(across, 0) << angle;
    }
  }
}

// What ends elsewhere than expected is looked for again: nothing that comes within the lesser reach is missing.
TEST(SelfCandidates, OfNodesThatEndElsewhereAreFound) {
  for (const bool closed : {false, true}) {
    const ClothPattern pattern = squareCloth(14, 13, 0.025, closed);
    SelfCandidates pairs(pattern);
    Random random(4);
    std::size_t more = 0;
    for (int round = 0; round < 20; ++round) {
      const auto seed = static_cast<std::uint64_t>(round + 1);
      const Field3 start = rotated(heap(pattern.grid, seed), 0.2 * round),
                   expected = moved(pattern, start, 0.004, seed);
      Candidates all;
      pairs.collect(start, expected, 0.006, all);
      const std::size_t before = all.edge_edges.size();
      for (int look = 0; look < 2; ++look) {
        Field3 end = moved(pattern, expected, 0.001, seed + 7);
        for (int k = 0; k < 1 + round; ++k) {
          const std::size_t n = pattern.grid.index(static_cast<int>(random.between(0.0, 13.99)),
                                                   static_cast<int>(random.between(0.0, 12.99)));
          end.set(n, end.at(n) + random.inBox(0.02));
        }
        pairs.collectDeviating(end, 0.0005, all);
        more += all.edge_edges.size() - before;
        Oracle({"elsewhere", pattern, start, end, 0.0005}).check(withoutDoubles(all));
      }
    }
    EXPECT_GT(more, 20u);
  }
}

TEST(SelfCandidates, EveryElementBelongsToOneQuad) {
  for (const bool closed : {false, true}) {
    const ClothPattern pattern = squareCloth(7, 9, 0.025, closed);
    std::multiset<Elements> found;
    const int quads = 6 * pattern.grid.linkCount();
    for (int q = 0; q < quads; ++q) {
      const QuadElements quad = quadElements(pattern.grid, q / pattern.grid.linkCount(), q % pattern.grid.linkCount());
      for (int k = 0; k < quad.vertex_count; ++k) found.insert({quad.vertices[static_cast<std::size_t>(k)]});
      for (int k = 0; k < quad.edge_count; ++k) {
        const MeshEdge& edge = quad.edges[static_cast<std::size_t>(k)];
        found.insert(sorted({edge.begin(), edge.end()}));
      }
      for (const MeshTriangle& t : quad.triangles) found.insert(sorted({t.begin(), t.end()}));
    }
    const std::size_t vertices = 7 * 9, triangles = 2 * static_cast<std::size_t>(quads);
    const std::size_t edges = vertices + triangles / 2 - (closed ? 0 : 1) + triangles / 2;  // Euler's formula
    EXPECT_EQ(found.size(), vertices + edges + triangles);
    EXPECT_EQ(std::set<Elements>(found.begin(), found.end()).size(), found.size());
  }
}

}  // namespace
}  // namespace curtain
